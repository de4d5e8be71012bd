/** The tiles of the recording that is shown: never those of the one before. */
import { useComputed, useSignal, type ReadonlySignal } from "@preact/signals";
import { useEffect } from "preact/hooks";
import { useStore } from "../context";
import { CurveTiles } from "./tiles";

export function useTiles(): ReadonlySignal<CurveTiles | null> {
  const store = useStore();
  const data = store.active.value?.data;
  const loaded = useSignal<CurveTiles | null>(null);
  useEffect(() => {
    let asked = true;
    void data?.curves().then(
      (list) => {
        if (asked && list) loaded.value = new CurveTiles(data, list);
      },
      () => undefined,
    );
    return () => void (asked = false);
  }, [data, loaded]);
  return useComputed(() => (loaded.value?.data === store.active.value?.data ? loaded.value : null));
}
