/** What the page of a library asks the server. */
import type {
  CallHits,
  LibraryEdit,
  LibraryFigure,
  LibraryHits,
  LibraryState,
  NamedHits,
  SearchRequest,
  Span,
  TablesChanged,
  TablesRequest,
} from "../../messages";
import { Api } from "../server/api";

export class LibraryApi extends Api {
  library(): Promise<LibraryState> {
    return this.get("/api/library", {});
  }

  editLibrary(edit: LibraryEdit): Promise<LibraryState> {
    return this.post("/api/library/edits", {}, edit);
  }

  /** Saved tables take the numbers and names of the library. */
  updateTables(sent: TablesRequest): Promise<TablesChanged> {
    return this.post("/api/library/tables", {}, sent);
  }

  nameHits(sent: CallHits): Promise<NamedHits> {
    return this.post("/api/library/names", {}, sent);
  }

  /** Refused with status 409 where a newer search was asked for meanwhile. */
  search(sent: SearchRequest): Promise<LibraryHits> {
    return this.post("/api/library/search", {}, sent);
  }

  figure({ recording, start_s, stop_s }: Span): Promise<LibraryFigure> {
    return this.get("/api/library/figure", {}, { recording, start: start_s, stop: stop_s });
  }
}
