// A running `slipway serve`, and a proxy that puts it under a path.
import { spawn, spawnSync } from "node:child_process";
import { mkdtempSync, readFileSync, rmSync, writeFileSync } from "node:fs";
import http from "node:http";
import { tmpdir } from "node:os";
import { join } from "node:path";

export const slipway = process.env.SLIPWAY;
const data = process.env.SLIPWAY_SOURCE + "/data";

export async function serve(...options) {
  const folder = mkdtempSync(join(tmpdir(), "slipway-dashboard-"));
  const child = spawn(slipway, ["serve", ...(options.includes("--data") ? [] : ["--data", data]), "--port", "0", "--jobs", join(folder, "jobs.sqlite"), ...options]);
  const line = await new Promise((resolve, reject) => {
    let text = "";
    child.stdout.on("data", (bytes) => {
      text += bytes;
      if (text.includes("\n")) resolve(text);
    });
    child.once("exit", (code) => reject(new Error(`the service ended with ${code}: ${text}`)));
  });
  const port = Number(/:(\d+),/.exec(line)[1]);
  const ended = new Promise((resolve) => child.once("exit", resolve));
  return {
    port,
    url: `http://127.0.0.1:${port}`,
    /** Seconds of the processor that it has used until now. */
    cpu_s() {
      const fields = readFileSync(`/proc/${child.pid}/stat`, "utf8").split(") ").at(-1).split(" ");
      return (Number(fields[11]) + Number(fields[12])) / 100; // user and system, in hundredths
    },
    async stop() {
      child.kill("SIGTERM");
      await ended;
      rmSync(folder, { recursive: true, force: true });
    },
  };
}

/** A file of tokens with one operator, and the token. */
export function tokens() {
  const made = spawnSync(slipway, ["token", "dashboard", "--role", "operator"], { encoding: "utf8" });
  const folder = mkdtempSync(join(tmpdir(), "slipway-tokens-"));
  writeFileSync(join(folder, "tokens.toml"), made.stdout);
  return { file: join(folder, "tokens.toml"), token: made.stderr.trim().split("\n").at(-1) };
}

/** What stands before the service and strips a prefix from the paths; answers to paths that it swallows never come. */
export async function proxy(port, prefix, { swallows = /(?!)/ } = {}) {
  const paths = [];
  const server = http.createServer((request, response) => {
    paths.push(request.url);
    if (!request.url.startsWith(prefix + "/")) {
      response.writeHead(404).end();
      return;
    }
    if (swallows.test(request.url)) return;
    const asked = http.request({ host: "127.0.0.1", port, method: request.method, path: request.url.slice(prefix.length), headers: request.headers }, (answer) => {
      response.writeHead(answer.statusCode, answer.headers);
      answer.pipe(response);
    });
    asked.on("error", () => response.destroy());
    request.pipe(asked);
  });
  await new Promise((resolve) => server.listen(0, "127.0.0.1", resolve));
  return { url: `http://127.0.0.1:${server.address().port}${prefix}`, paths, stop: () => new Promise((resolve) => { server.closeAllConnections(); server.close(resolve); }) };
}
