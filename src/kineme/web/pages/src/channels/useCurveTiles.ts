/** Return the curve tiles of the active recording; null while loading. */
import { useComputed, useSignal, type ReadonlySignal } from "@preact/signals";
import { useEffect } from "preact/hooks";
import { useStore } from "../context";
import { CurveTiles } from "./tiles";

export function useCurveTiles(): ReadonlySignal<CurveTiles | null> {
  const store = useStore();
  const data = store.active.value?.data;
  const loaded = useSignal<CurveTiles | null>(null);
  useEffect(() => {
    let isCurrent = true;
    void data?.loadCurves().then(
      (list) => {
        if (isCurrent && list) loaded.value = new CurveTiles(data, list);
      },
      () => undefined,
    );
    return () => void (isCurrent = false);
  }, [data, loaded]);
  return useComputed(() => (loaded.value?.data === store.active.value?.data ? loaded.value : null));
}
