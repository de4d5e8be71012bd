/** The page of a report. */
import type { JSX } from "preact";
import { Layout } from "../layout/Layout";
import type { Store } from "../store";

export function Report({ store }: { store: Store }): JSX.Element {
  return (
    <Layout
      header={<h1>{store.recording.value?.name}</h1>}
      viewer={null}
      matrix={null}
      side={null}
      transport={null}
      timeline={null}
    />
  );
}
