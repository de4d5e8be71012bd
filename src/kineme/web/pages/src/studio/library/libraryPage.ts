/** Hold the state of a library's page and change it. */
import { formatCount } from "../../util";
import { computed, signal } from "@preact/signals";
import type { LibraryCluster, LibraryEdit, LibraryHit, LibraryState, Span } from "../../messages";
import { Refused, describeUnchanged, explainError, type Api } from "../server/api";
import { Sketches } from "./Figure";

/** Examples and counterexamples of a search. */
interface Question {
  title: string;
  like: Span[];
  unlike: Span[];
  cluster?: number;
}

export class LibraryPage {
  readonly state = signal<LibraryState | null>(null);
  readonly tab = signal("clusters");
  /** The last problem; empty after a success. */
  readonly problem = signal("");
  readonly question = signal<Question | null>(null);
  readonly searching = signal(false);
  readonly naming = signal(false);
  /** Result of the last table update, and how many clusters kept another name. */
  readonly tablesNews = signal({ text: "", others: 0 });
  /** Result of the last naming of hits. */
  readonly news = signal("");
  readonly hits = signal<LibraryHit[]>([]);
  readonly threshold = signal(0.85);
  readonly mirror = signal(true);
  readonly playing = signal(false);
  /** Span shown in the search form. */
  readonly span = signal<Span | null>(null);
  /** Judged hits, by `getHitKey`. */
  readonly verdicts = signal<ReadonlyMap<string, { hit: LibraryHit; right: boolean }>>(new Map());
  /** Key of the current hit; if it is not shown, the first is current. */
  readonly frontKey = signal("");
  readonly frontIndex = computed(() => {
    const at = this.hits.value.findIndex((hit) => getHitKey(hit) === this.frontKey.value);
    return at < 0 ? 0 : at;
  });
  readonly confirmed = computed(() => this.filterHits(true));
  readonly refused = computed(() => this.filterHits(false));
  readonly shares = computed(() => countByCluster(this.confirmed.value));
  readonly sketches: Sketches;
  private searchCount = 0;

  constructor(readonly api: Api) {
    this.sketches = new Sketches(api);
  }

  async load(): Promise<void> {
    await this.attempt(async () => (this.state.value = await this.api.loadLibrary()));
  }

  /** Save an edit; return whether that worked. */
  async edit(edit: LibraryEdit): Promise<boolean> {
    return this.attempt(async () => {
      this.state.value = await this.api.editLibrary(edit);
      this.hits.value = this.hits.value.map((hit) => ({
        ...hit,
        label: this.getClusterName(hit.cluster),
      }));
    }, "Not saved: ");
  }

  /** Write numbers and names to saved tables; with `names`, also replace other names. */
  async updateTables(names: boolean): Promise<void> {
    await this.attempt(async () => {
      const changed = await this.api.updateTables({ names });
      const tables = formatCount(changed.tables, "saved table");
      const text = `Other numbers or names in ${tables} now.${describeUnchanged(changed)}`;
      this.tablesNews.value = { text, others: changed.others };
    });
  }

  /** Name the confirmed segments one by one. */
  async nameHits(name: string): Promise<void> {
    const hits = this.confirmed.value;
    this.naming.value = true;
    const done = await this.attempt(async () => {
      const { named, left } = await this.api.nameHits({ name, hits: hits.map(toSpan) });
      const lost = left.length ? ` Not named: ${left.join("; ")}.` : "";
      this.news.value = `${named} of ${hits.length} named, in the tables beside their recordings.${lost}`;
    }, "Not saved: ");
    this.naming.value = false;
    if (done) await this.searchAgain();
  }

  /** Start a new search and forget all verdicts. */
  async startSearch(question: Question): Promise<void> {
    this.verdicts.value = new Map();
    this.news.value = "";
    this.tab.value = "search";
    this.hits.value = [];
    await this.search(question);
  }

  /** Search again with confirmed hits as examples and refused ones as counterexamples. */
  async refine(): Promise<void> {
    const asked = this.question.value;
    if (!asked) return;
    const like = [...asked.like, ...this.confirmed.value.map(toSpan)];
    await this.search({ ...asked, like, unlike: this.refused.value.map(toSpan) }, asked);
  }

  async searchAgain(): Promise<void> {
    if (this.question.value) await this.search(this.question.value);
  }

  /** Record a verdict; repeating it removes it. */
  judge(hit: LibraryHit, right: boolean): void {
    const verdicts = new Map(this.verdicts.value);
    if (verdicts.get(getHitKey(hit))?.right === right) verdicts.delete(getHitKey(hit));
    else verdicts.set(getHitKey(hit), { hit, right });
    this.verdicts.value = verdicts;
    this.news.value = ""; // it was about other hits
  }

  getClusterName(cluster: number): string {
    return this.state.value?.clusters.find((each) => each.cluster === cluster)?.label ?? "";
  }

  private async search(question: Question, shown = question): Promise<void> {
    const mine = ++this.searchCount;
    this.question.value = shown;
    this.searching.value = true;
    await this.attempt(async () => {
      const { like, unlike, cluster } = question;
      const found = await this.api.search({
        like,
        unlike,
        ...(cluster === undefined ? {} : { cluster }),
        threshold: this.threshold.value,
        mirror: this.mirror.value,
        top: 60,
      });
      if (mine === this.searchCount) this.hits.value = found.hits;
    });
    if (mine === this.searchCount) this.searching.value = false;
  }

  private filterHits(verdict: boolean): LibraryHit[] {
    return [...this.verdicts.value.values()]
      .filter(({ right }) => right === verdict)
      .map(({ hit }) => hit);
  }

  private async attempt(work: () => Promise<unknown>, prefix = ""): Promise<boolean> {
    try {
      await work();
      this.problem.value = "";
      return true;
    } catch (error) {
      const newer = error instanceof Refused && error.status === 409;
      if (!newer) this.problem.value = prefix + explainError(error);
      return false;
    }
  }
}

function toSpan({ recording, start_s, stop_s }: LibraryHit): Span {
  return { recording, start_s, stop_s };
}

/** Return a key that identifies a hit's span. */
export function getHitKey(hit: LibraryHit): string {
  return JSON.stringify([hit.recording, hit.start_s, hit.stop_s]);
}

/** Count hits per cluster, most first; -1 is no cluster. */
export function countByCluster(hits: readonly LibraryHit[]): [cluster: number, hits: number][] {
  const counts = new Map<number, number>();
  for (const { cluster } of hits) counts.set(cluster, (counts.get(cluster) ?? 0) + 1);
  return [...counts].sort((a, b) => b[1] - a[1] || a[0] - b[0]);
}

export type Order = "seconds" | "count" | "name" | "unsure";

export function sortClusters(clusters: readonly LibraryCluster[], by: Order): LibraryCluster[] {
  const times = (each: LibraryCluster): number => each.repetitions || each.activities;
  const compare: Record<Order, (a: LibraryCluster, b: LibraryCluster) => number> = {
    seconds: (a, b) => b.seconds - a.seconds,
    count: (a, b) => times(b) - times(a),
    name: (a, b) =>
      Number(!a.label) - Number(!b.label) ||
      a.label.localeCompare(b.label) ||
      a.cluster - b.cluster,
    unsure: (a, b) => b.unsure - a.unsure,
  };
  return [...clusters].sort(compare[by]);
}

const COLUMNS = ["recording", "start_s", "stop_s", "distance", "cluster", "label", "name"] as const;

type Verdict = (hit: LibraryHit) => boolean | undefined;

/** Return hits and verdicts as JSON lines, as `kineme library search --json` does. */
export function toJson(hits: readonly LibraryHit[], verdict: Verdict): string {
  return hits
    .map((hit) => JSON.stringify({ ...hit, confirmed: verdict(hit) ?? null }) + "\n")
    .join("");
}

export function toCsv(hits: readonly LibraryHit[], verdict: Verdict): string {
  const cell = (value: string | number | boolean | null | undefined): string => {
    const text = String(value ?? "");
    return /[",\r\n]/.test(text) ? `"${text.replaceAll('"', '""')}"` : text;
  };
  const rows = hits.map((hit) => [...COLUMNS.map((name) => hit[name]), verdict(hit)]);
  return [[...COLUMNS, "confirmed"], ...rows].map((row) => row.map(cell).join(",") + "\n").join("");
}

export function formatSeconds(value: number): string {
  const minutes = Math.floor(value / 60);
  return minutes
    ? `${minutes}:${(value % 60).toFixed(0).padStart(2, "0")} min`
    : `${value.toFixed(2)} s`;
}
