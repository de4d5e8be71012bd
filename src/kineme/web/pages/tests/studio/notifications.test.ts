import { batch, signal } from "@preact/signals";
import { beforeEach, expect, it, vi } from "vitest";
import { Notifications } from "../../src/studio/notifications";

const inFront = signal("take 1");

beforeEach(() => {
  vi.stubGlobal("window", { setTimeout: () => 0, clearTimeout: () => undefined });
  inFront.value = "take 1";
});

it("tells news of a table only while that is in front", () => {
  const notifications = new Notifications(() => inFront.value);
  notifications.tell("4 segments named");
  expect(notifications.news.value?.text).toBe("4 segments named");
  inFront.value = "take 2"; // one more edit, or its undo
  expect(notifications.news.value).toBeNull();
});

it("keeps news that are told together with the table they are of", () => {
  const notifications = new Notifications(() => inFront.value);
  batch(() => {
    inFront.value = "take 2";
    notifications.tell("4 segments named");
  });
  expect(notifications.news.value?.text).toBe("4 segments named");
});
