import { expect, test } from "vitest";
import { buildAddress, buildPageAddress } from "../../src/studio/server/address";

test("names in a path are filled in, and escaped", () => {
  const path = "/api/recordings/{id}/export/{format}";
  const address = buildAddress(path, { id: "a/$& b", format: "csv" }, { level: "" });
  expect(address).toBe("/api/recordings/a%2F%24%26%20b/export/csv?level=");
  expect(buildAddress("/api/state", {})).toBe("/api/state");
});

test("a path that the server has not is an error of types", () => {
  // @ts-expect-error the server has no such path
  expect(buildAddress("/api/footage", {})).toBe("/api/footage");
  // @ts-expect-error nor is this the name in braces
  expect(buildAddress("/api/recordings/{id}", { name: "a" })).toContain("{id}");
});

test("a page is that of the library, or of a recording at a time", () => {
  expect(buildPageAddress("t")).toBe("?token=t");
  expect(buildPageAddress("t", "a b")).toBe("?token=t&open=a+b");
  expect(buildPageAddress("t", "a", 1.5)).toBe("?token=t&open=a&at=1.500");
});
