import { expect, test } from "vitest";
import type { LibraryCluster, LibraryHit } from "../../src/messages";
import { findWidestDirection } from "../../src/studio/library/Figure";
import { countByCluster, sortClusters, toCsv, toJson } from "../../src/studio/library/libraryPage";

const hit = (some: Partial<LibraryHit>): LibraryHit => ({
  recording: "a.bvh",
  start_s: 1,
  stop_s: 2,
  distance: 0.5,
  cluster: 3,
  label: "",
  name: "",
  ...some,
});

test("the clusters of what was confirmed are told, most first, none last of as many", () => {
  const clusters = [3, -1, 5, 5, 3, 5].map((cluster) => hit({ cluster }));
  expect(countByCluster(clusters)).toEqual([
    [5, 3],
    [3, 2],
    [-1, 1],
  ]);
});

test("hits are taken along with what was said of them", () => {
  const hits = [hit({}), hit({ recording: 'b, "c".bvh', label: "walk" })];
  const said = (each: LibraryHit): boolean | undefined => (each.label ? true : undefined);
  expect(toCsv(hits, said).split("\n")).toEqual([
    "recording,start_s,stop_s,distance,cluster,label,name,confirmed",
    "a.bvh,1,2,0.5,3,,,",
    '"b, ""c"".bvh",1,2,0.5,3,walk,,true',
    "",
  ]);
  const lines = toJson(hits, said).trim().split("\n");
  expect(lines.map((line) => (JSON.parse(line) as { confirmed: unknown }).confirmed)).toEqual([
    null,
    true,
  ]);
});

test("clusters are ordered by name, those without one last", () => {
  const clusters = ["", "walk", "jump", ""].map((label, cluster) => ({ cluster, label }));
  const found = sortClusters(clusters as LibraryCluster[], "name");
  expect(found.map(({ cluster }) => cluster)).toEqual([2, 1, 0, 3]);
});

test("a body is seen from the side from which it moves most", () => {
  const bodies = [-1, 0, 1].map((z) => Float32Array.from([5, 1, 2, 0.1 * z, 1, z]));
  expect(Math.abs(Math.tan(findWidestDirection(bodies)))).toBeGreaterThan(5);
  expect(findWidestDirection([])).toBe(0);
});
