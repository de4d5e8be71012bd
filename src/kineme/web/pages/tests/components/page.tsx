/** Render studio components with an open recording and a server that edits it. */
import { render, type RenderResult } from "@testing-library/preact";
import type { JSX } from "preact";
import { Store, StoreProvider } from "../../src/store";
import type { Segments, State } from "../../src/messages";
import { StudioProvider, StudioView, type StudioServices } from "../../src/studio/context";
import { Editor } from "../../src/studio/editing/editor";
import { Poses } from "../../src/studio/poses";
import { Review } from "../../src/studio/review/review";
import type { Api } from "../../src/studio/server/api";
import { Uploads } from "../../src/studio/folder/folder";
import { Session } from "../../src/studio/session";
import { Server } from "../studio/server";
import { recording } from "../studio/tables";

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
  const editor = new Editor(session);
  const review = new Review(session, editor);
  const [uploads, poses] = [new Uploads(session), new Poses(session)];
  const services = { session, editor, review, uploads, poses, view: new StudioView() };
  store.edit.value = (edit) => editor.edit(edit);
  await session.open("take");
  const page = render(
    <StoreProvider value={store}>
      <StudioProvider value={services}>{component}</StudioProvider>
    </StoreProvider>,
  );
  return { ...page, store, services, server };
}
