/** Remember the edited level of each recording. */
import { computed, effect, untracked } from "@preact/signals";
import type { Store } from "../store";

const KEY = "kineme.level";

export function rememberLevel(store: Store): void {
  const key = computed(() => `${KEY}|${location.pathname}|${store.recording.value?.id ?? ""}`);
  effect(() => {
    const level = localStorage.getItem(key.value) === "activity" ? "activity" : "primitive";
    untracked(() => (store.level.value = level));
  });
  effect(() => {
    const level = store.level.value;
    if (level === "activity") localStorage.setItem(key.peek(), level);
    else localStorage.removeItem(key.peek());
  });
}
