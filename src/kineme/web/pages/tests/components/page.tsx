/** Render studio components with an open recording and a server that edits it. */
import { cleanup, render, type RenderResult } from "@testing-library/preact";
import type { JSX } from "preact";
import { afterEach } from "vitest";
import { Store, StoreProvider } from "../../src/store";
import type { Segments, State } from "../../src/messages";
import { createServices, StudioProvider, type StudioServices } from "../../src/studio/context";
import type { Api } from "../../src/studio/server/api";
import { Session } from "../../src/studio/session";
import { Server } from "../studio/server";
import { recording } from "../studio/tables";

afterEach(cleanup); // of each file that imports this one

export interface Page extends RenderResult {
  store: Store;
  services: StudioServices;
  server: Server;
}

export async function show(component: JSX.Element, table: Segments): Promise<Page> {
  const server = new Server(recording(table));
  const loadState = () => Promise.resolve({ recordings: [], labels: [] } as unknown as State);
  const api = Object.assign(server, { loadState }) as unknown as Api;
  const store = new Store();
  const session = new Session(api, store);
  const services = createServices(session);
  await session.open("take");
  const page = render(
    <StoreProvider value={store}>
      <StudioProvider value={services}>{component}</StudioProvider>
    </StoreProvider>,
  );
  return { ...page, store, services, server };
}
