import { defineConfig } from "vite";

// Relative addresses, so that a proxy may put the service under any path; nothing inline, as the page's policy demands.
export default defineConfig({
  base: "./",
  build: {
    target: "es2022",
    assetsInlineLimit: 0,
    modulePreload: false,
    reportCompressedSize: false,
    chunkSizeWarningLimit: 2000,
  },
});
