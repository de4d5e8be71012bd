/** What a cluster of one recording is called now, offered for all recordings of the folder. */
import { counted } from "../../counted";
import { effect, signal, untracked } from "@preact/signals";
import type { Segments } from "../../messages";
import type { Session } from "../session";
import type { Folder } from "./folder";

export interface Offer {
  recording: string;
  cluster: number;
  before: string;
  label: string;
}

type Names = Readonly<Record<string, string>>;

export class NameOffer {
  /** null where there is nothing to offer. */
  readonly present = signal<Offer | null>(null);
  private last: { id: string; names: Names } | null = null;

  private readonly session: Session;

  constructor(private readonly folder: Folder) {
    const { session } = folder;
    this.session = session;
    effect(() => {
      const { id, segmentation, finding } = session.edited.value?.confirmed.value ?? {};
      if (!id || !segmentation || finding) return;
      const names = segmentation.cluster_names;
      const last = this.last?.id === id ? this.last.names : names;
      this.last = { id, names };
      const other = otherName(last, names);
      untracked(() => {
        if (this.present.value?.recording !== id) this.present.value = null;
        if (other)
          this.present.value = this.isUseful(id, other) ? { recording: id, ...other } : null;
      });
    });
  }

  /** Gives the name to all recordings; undo is in each of them. */
  async take(): Promise<void> {
    const { api, bulletin, state } = this.session;
    const offer = this.present.value;
    if (!offer) return;
    this.present.value = null;
    await bulletin.attempt("offer", async () => {
      const { tables, others, left } = await api.callEverywhere(offer, this.isLibrary());
      const kept = others ? ` Another name stays with ${counted(others, "cluster")} there.` : "";
      const lost = left.length ? ` Not changed: ${left.join("; ")}.` : "";
      bulletin.tell(`“${offer.label}” in ${counted(tables, "saved table")} more.${kept}${lost}`);
      if (state.value) await this.session.refresh();
    });
  }

  isLibrary(): boolean {
    return this.session.state.value?.of_library ?? false;
  }

  /** Whether others have what was named, as far as is known. */
  private isUseful(id: string, { before, label }: { before: string; label: string }): boolean {
    const others = this.folder.members.value.filter(({ listing }) => listing.id !== id);
    if (!others.length || !label) return false;
    if (this.isLibrary() || (before && !this.folder.ready.value)) return true;
    const has = (table: Segments): boolean => table.segments.some((row) => row.label === before);
    return before !== "" && others.some(({ table }) => table && has(table));
  }
}

/** The one cluster whose name is another now; null where none is, or several are. */
function otherName(last: Names, names: Names): Omit<Offer, "recording"> | null {
  const all = new Set([...Object.keys(last), ...Object.keys(names)]);
  const changed = [...all].filter((cluster) => (last[cluster] ?? "") !== (names[cluster] ?? ""));
  const [cluster] = changed;
  if (cluster === undefined || changed.length > 1) return null;
  return {
    cluster: Number(cluster),
    before: last[cluster] ?? "",
    label: names[cluster] ?? "",
  };
}
