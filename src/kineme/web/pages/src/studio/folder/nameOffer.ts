/** Offer to apply a cluster's new name to all recordings of the folder. */
import { formatCount } from "../../formatCount";
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
  /** null if there is nothing to offer. */
  readonly present = signal<Offer | null>(null);
  private lastNames: { id: string; names: Names } | null = null;

  private readonly session: Session;

  constructor(private readonly folder: Folder) {
    const { session } = folder;
    this.session = session;
    effect(() => {
      const { id, segmentation, finding } = session.edited.value?.confirmed.value ?? {};
      if (!id || !segmentation || finding) return;
      const names = segmentation.cluster_names;
      const last = this.lastNames?.id === id ? this.lastNames.names : names;
      this.lastNames = { id, names };
      const other = findRenamed(last, names);
      untracked(() => {
        if (this.present.value?.recording !== id) this.present.value = null;
        if (other)
          this.present.value = this.isUseful(id, other) ? { recording: id, ...other } : null;
      });
    });
  }

  /** Apply the name to all recordings; each can undo it. */
  async accept(): Promise<void> {
    const { api, notifications, state } = this.session;
    const offer = this.present.value;
    if (!offer) return;
    this.present.value = null;
    await notifications.attempt("offer", async () => {
      const { tables, others, left } = await api.renameEverywhere(offer, this.isLibrary());
      const kept = others
        ? ` Another name stays with ${formatCount(others, "cluster")} there.`
        : "";
      const lost = left.length ? ` Not changed: ${left.join("; ")}.` : "";
      notifications.tell(
        `“${offer.label}” in ${formatCount(tables, "saved table")} more.${kept}${lost}`,
      );
      if (state.value) await this.session.refresh();
    });
  }

  isLibrary(): boolean {
    return this.session.state.value?.of_library ?? false;
  }

  /** Return whether other recordings may have the named cluster. */
  private isUseful(id: string, { before, label }: { before: string; label: string }): boolean {
    const others = this.folder.members.value.filter(({ listing }) => listing.id !== id);
    if (!others.length || !label) return false;
    if (this.isLibrary() || (before && !this.folder.isReady.value)) return true;
    const has = (table: Segments): boolean => table.segments.some((row) => row.label === before);
    return before !== "" && others.some(({ table }) => table && has(table));
  }
}

/** Return the one cluster whose name changed; null if none or several did. */
function findRenamed(last: Names, names: Names): Omit<Offer, "recording"> | null {
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
