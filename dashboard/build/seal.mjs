// Writes beside the bundle what it was built from: the hash of its sources, which tests compare without npm.
import { createHash } from "node:crypto";
import { readdirSync, readFileSync, statSync, writeFileSync } from "node:fs";
import { join } from "node:path";

// src/api/types.ts says what the compiler checks, and nothing of it is in the bundle.
const left_out = new Set(["src/api/types.ts"]);
const files = (folder) => readdirSync(folder).flatMap((name) => {
  const path = join(folder, name);
  return statSync(path).isDirectory() ? files(path) : [path];
});
const sources = ["index.html", "package-lock.json", "package.json", "tsconfig.json", "vite.config.ts", ...files("src")].filter((f) => !left_out.has(f)).sort();
const lines = sources.map((file) => `${createHash("sha256").update(readFileSync(file)).digest("hex")}  ${file}\n`);
writeFileSync("dist/sources.sha256", lines.join(""));
