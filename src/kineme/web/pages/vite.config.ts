import { createHash } from "node:crypto";
import { fileURLToPath } from "node:url";
import { defineConfig, type Plugin } from "vite";

const here = (path: string): string => fileURLToPath(new URL(path, import.meta.url));

// Names without hashes: the built files are committed, and a rebuild must give the same ones.
const names = {
  entryFileNames: "assets/[name].js",
  chunkFileNames: "assets/[name].js",
  assetFileNames: "assets/[name][extname]",
};

export default defineConfig(({ mode }) => {
  const page = mode === "report" || mode === "library" ? mode : "studio";
  return {
    base: "./",
    plugins: page === "report" ? [oneFile()] : [],
    build: {
      outDir: here("../static"),
      emptyOutDir: page === "studio", // the studio is built first
      target: "es2022",
      modulePreload: false,
      sourcemap: false,
      chunkSizeWarningLimit: 1500,
      rolldownOptions: {
        input: here(`${page}.html`),
        output: { ...names, codeSplitting: false },
      },
    },
    test: { include: ["tests/**/*.test.ts"] },
  };
});

/** The report as one page: script and style inside it, and a policy that lets nothing else run. */
function oneFile(): Plugin {
  return {
    name: "one-file",
    enforce: "post",
    generateBundle(_options, bundle) {
      let page = "";
      let script = "";
      let style = "";
      for (const [name, file] of Object.entries(bundle)) {
        if (file.type === "chunk") script = file.code;
        else if (name.endsWith(".css")) style = String(file.source);
        else if (name.endsWith(".html")) page = String(file.source);
        if (!name.endsWith(".html")) delete bundle[name];
      }
      script = script.replaceAll("</script", "<\\/script").replaceAll("<!--", "<\\!--").trim();
      style = style.trim();
      const policy = `default-src 'none'; script-src ${hash(script)}; style-src ${hash(style)}; img-src blob: data:; base-uri 'none'; form-action 'none'`;
      page = page
        .replace(/\s*<script type="module"[^>]*><\/script>/, "")
        .replace(/\s*<link rel="stylesheet"[^>]*>/, "")
        .replace(
          "<!--policy-->",
          `<meta http-equiv="Content-Security-Policy" content="${policy}" />`,
        )
        .replace("<!--style-->", () => `<style>${style}</style>`)
        .replace("<!--script-->", () => `<script type="module">${script}</script>`);
      const html = Object.values(bundle).find((file) => file.fileName.endsWith(".html"));
      if (html?.type === "asset") html.source = page;
    },
  };
}

function hash(text: string): string {
  return `'sha256-${createHash("sha256").update(text).digest("base64")}'`;
}
