import { createHash } from "node:crypto";
import { fileURLToPath } from "node:url";
import { defineConfig, type Connect, type Plugin } from "vite";

const resolvePath = (path: string): string => fileURLToPath(new URL(path, import.meta.url));

const GENERATED = "Built from src/kineme/web/pages by npm run build: change it there.";

/** Address of `kineme studio --dev`, which accepts requests from this development server. */
const STUDIO = `http://127.0.0.1:${process.env.KINEME_PORT ?? 8750}`;

// Names without hashes: the built files are committed, and a rebuild must give the same ones.
const OUTPUT_NAMES = {
  entryFileNames: "assets/[name].js",
  chunkFileNames: "assets/[name].js",
  assetFileNames: "assets/[name][extname]",
};

export default defineConfig(({ mode }) => {
  const page = ["report", "library", "live"].includes(mode) ? mode : "studio";
  return {
    base: "./",
    plugins: [page === "report" && inlineAssets(), addGeneratedNotice(), servePages()],
    server: {
      host: "127.0.0.1",
      port: 5173,
      strictPort: true, // the studio accepts no other port
      proxy: { "/api": { target: STUDIO, changeOrigin: true } },
    },
    build: {
      outDir: resolvePath("../static"),
      emptyOutDir: page === "studio", // the studio is built first
      target: "es2022",
      modulePreload: false,
      sourcemap: false,
      chunkSizeWarningLimit: 1500,
      rolldownOptions: {
        input: resolvePath(`${page}.html`),
        output: { ...OUTPUT_NAMES, codeSplitting: false },
      },
    },
    test: {
      include: ["tests/**/*.test.{ts,tsx}"],
      environment: "happy-dom",
      setupFiles: ["tests/browser.ts"],
    },
  };
});

/** During development, serve the sources of the page that the studio shows at an address. */
function servePages(): Plugin {
  const handleRequest: Connect.NextHandleFunction = (request, _response, next) => {
    const url = request.url ?? "";
    if (!/^\/(\?|$)/.test(url)) return next();
    fetch(STUDIO + url)
      .then((shown) => shown.text())
      .then((html) => {
        const page = html.includes("assets/library.js") ? "library" : "studio";
        request.url = url.replace("/", `/${page}.html`);
        next();
      })
      .catch(() => next(new Error(`Nothing answers at ${STUDIO}: start kineme studio --dev.`)));
  };
  return {
    name: "page-of-studio",
    apply: "serve",
    configureServer: (server) => void server.middlewares.use(handleRequest),
  };
}

/** Start each built file with a notice that it is generated. */
function addGeneratedNotice(): Plugin {
  return {
    name: "generated",
    enforce: "post",
    generateBundle(_options, bundle) {
      for (const file of Object.values(bundle)) {
        if (file.type === "chunk") file.code = `/* ${GENERATED} */\n${file.code}`;
        else if (file.fileName.endsWith(".css"))
          file.source = `/* ${GENERATED} */\n${String(file.source)}`;
        else if (file.fileName.endsWith(".html"))
          file.source = String(file.source).replace(
            /^.*\n/,
            (first) => `${first}<!-- ${GENERATED} -->\n`,
          );
      }
    },
  };
}

/** Inline script and style into the report, with a policy that blocks everything else. */
function inlineAssets(): Plugin {
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
      const policy = `default-src 'none'; script-src ${computeHash(script)}; style-src ${computeHash(style)}; img-src blob: data:; media-src 'self' file:; base-uri 'none'; form-action 'none'`;
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

function computeHash(text: string): string {
  return `'sha256-${createHash("sha256").update(text).digest("base64")}'`;
}
