/** Provide the store to all components of a page. */
import { createContext } from "preact";
import { useContext } from "preact/hooks";
import type { Store } from "./store";

const StoreContext = createContext<Store | null>(null);

export const StoreProvider = StoreContext.Provider;

export function useStore(): Store {
  const store = useContext(StoreContext);
  if (!store) throw new Error("A component stands outside of the StoreProvider.");
  return store;
}
