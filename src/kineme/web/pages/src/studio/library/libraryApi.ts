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
} from "../../messages";
import { Api } from "../server/api";

export class LibraryApi extends Api {
  library(): Promise<LibraryState> {
    return this.json("/api/library");
  }

  editLibrary(edit: LibraryEdit): Promise<LibraryState> {
    return this.json("/api/library/edits", edit);
  }

  nameHits(sent: CallHits): Promise<NamedHits> {
    return this.json("/api/library/names", sent);
  }

  /** Refused with status 409 where a newer search was asked for meanwhile. */
  search(sent: SearchRequest): Promise<LibraryHits> {
    return this.json("/api/library/search", sent);
  }

  figure({ recording, start_s, stop_s }: Span): Promise<LibraryFigure> {
    const asked = new URLSearchParams({
      recording,
      start: String(start_s),
      stop: String(stop_s),
    });
    return this.json(`/api/library/figure?${asked}`);
  }
}
