/** Send the requests of a library's page. */
import type * as messages from "../../messages";
import { Api } from "../server/api";

export class LibraryApi extends Api {
  loadLibrary(): Promise<messages.LibraryState> {
    return this.get("/api/library", {});
  }

  editLibrary(edit: messages.LibraryEdit): Promise<messages.LibraryState> {
    return this.post("/api/library/edits", {}, edit);
  }

  /** Write the library's numbers and names to saved tables. */
  updateTables(sent: messages.TablesRequest): Promise<messages.TablesChanged> {
    return this.post("/api/library/tables", {}, sent);
  }

  nameHits(sent: messages.CallHits): Promise<messages.NamedHits> {
    return this.post("/api/library/names", {}, sent);
  }

  /** Search; refused with status 409 if a newer search was sent meanwhile. */
  search(sent: messages.SearchRequest): Promise<messages.LibraryHits> {
    return this.post("/api/library/search", {}, sent);
  }

  loadFigure({ recording, start_s, stop_s }: messages.Span): Promise<messages.LibraryFigure> {
    return this.get("/api/library/figure", {}, { recording, start: start_s, stop: stop_s });
  }
}
