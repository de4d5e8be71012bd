/** Check the imports and the size of folders. */
import { readdirSync, readFileSync, statSync } from "node:fs";
import { basename, dirname, join, normalize } from "node:path";
import { expect, test } from "vitest";

const SRC = join(import.meta.dirname, "..", "src");
const MAX_FILES = 20;

function listFolders(folder: string): string[] {
  const inside = readdirSync(folder).map((name) => join(folder, name));
  return [folder, ...inside.filter((path) => statSync(path).isDirectory()).flatMap(listFolders)];
}

const folders = listFolders(SRC);
const files = folders.flatMap((folder) =>
  readdirSync(folder)
    .filter((name) => /\.tsx?$/.test(name))
    .map((name) => join(folder, name)),
);

/** Return the files that a file imports, including types. */
function listImports(file: string): string[] {
  const specs = readFileSync(file, "utf-8").matchAll(/(?:from|import) "(\.[^"]+)"/g);
  return [...specs]
    .map(([, spec]) => normalize(join(dirname(file), spec!)))
    .flatMap((path) => files.filter((each) => each === `${path}.ts` || each === `${path}.tsx`));
}

test("no files import each other in a circle", () => {
  const imports = new Map(files.map((file) => [file, listImports(file)]));
  const done = new Set<string>();
  const visit = (file: string, above: string[]): void => {
    expect(above, `circle through ${file}`).not.toContain(file);
    if (done.has(file)) return;
    for (const each of imports.get(file)!) visit(each, [...above, file]);
    done.add(file);
  };
  expect(files.length).toBeGreaterThan(50);
  for (const file of files) visit(file, []);
});

test("what the report and the studio share knows neither of them", () => {
  const pages = /\/src\/(report|studio)\//;
  const shared = files.filter((file) => !pages.test(file));
  expect(shared.filter((file) => listImports(file).some((each) => pages.test(each)))).toEqual([]);
});

test("the server is asked in one place", () => {
  const requesting = files.filter((file) =>
    /\bfetch\(|EventSource\(|XMLHttpRequest\(|["`]\/api/.test(readFileSync(file, "utf-8")),
  );
  const allowed = ["api.ts", "paths.ts"];
  expect(requesting.filter((file) => !allowed.includes(basename(file)))).toEqual([]);
});

test.each(folders)("%s holds no more files than one looks through", (folder) => {
  const own = readdirSync(folder).filter((name) => statSync(join(folder, name)).isFile());
  expect(own.length).toBeLessThanOrEqual(MAX_FILES);
});
