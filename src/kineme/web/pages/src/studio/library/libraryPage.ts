/** The library that is shown: what it holds, what is searched for, what was said of the hits. */
import { counted } from "../../counted";
import { computed, signal } from "@preact/signals";
import type { LibraryEdit, LibraryHit, LibraryState, Span } from "../../messages";
import { explain, Refused } from "../server/answers";
import { keyOf, sharesOf } from "./hits";
import { Sketches } from "./Figure";
import type { LibraryApi } from "./libraryApi";

/** What is searched for, and how far from it. */
export interface Question {
  title: string;
  like: Span[];
  unlike: Span[];
  cluster?: number;
}

export class LibraryPage {
  readonly state = signal<LibraryState | null>(null);
  readonly tab = signal("clusters");
  /** What went wrong last; empty once something went well. */
  readonly problem = signal("");
  readonly question = signal<Question | null>(null);
  readonly searching = signal(false);
  readonly naming = signal(false);
  /** What became of saved tables, and how many clusters in them keep another name. */
  readonly tablesNews = signal({ text: "", others: 0 });
  /** What became of names given to hits. */
  readonly news = signal("");
  readonly hits = signal<LibraryHit[]>([]);
  readonly threshold = signal(0.85);
  readonly mirror = signal(true);
  readonly playing = signal(false);
  /** The span that the form of the search shows. */
  readonly span = signal<Span | null>(null);
  /** The hits of which somebody has said whether they are right, by `keyOf`. */
  readonly verdicts = signal<ReadonlyMap<string, { hit: LibraryHit; right: boolean }>>(new Map());
  /** The hit that keys are about, by `keyOf`; the first where it is none of those shown. */
  readonly front = signal("");
  readonly inFront = computed(() => {
    const at = this.hits.value.findIndex((hit) => keyOf(hit) === this.front.value);
    return at < 0 ? 0 : at;
  });
  readonly confirmed = computed(() => this.hitsOf(true));
  readonly refused = computed(() => this.hitsOf(false));
  readonly shares = computed(() => sharesOf(this.confirmed.value));
  readonly sketches: Sketches;
  private asked = 0;

  constructor(readonly api: LibraryApi) {
    this.sketches = new Sketches(api);
  }

  async start(): Promise<void> {
    await this.trying(async () => (this.state.value = await this.api.library()));
  }

  /** The library as it is now, others may have named clusters; what went wrong stays shown. */
  async refresh(): Promise<void> {
    if (this.state.value && !this.problem.value) await this.start();
  }

  /** The edit is on the disk once this has ended; whether it was made. */
  async edit(edit: LibraryEdit): Promise<boolean> {
    const made = await this.trying(async () => {
      this.state.value = await this.api.editLibrary(edit);
    });
    if (made) this.relabel();
    else this.problem.value = `Not saved: ${this.problem.value}`;
    return made;
  }

  /** Saved tables take numbers and names of the library; those of another name, if `names`. */
  async updateTables(names: boolean): Promise<void> {
    await this.trying(async () => {
      const { tables, others, left } = await this.api.updateTables({ names });
      const kept = others ? ` Another name stays with ${counted(others, "cluster")} in them.` : "";
      const lost = left.length ? ` Not changed: ${left.join("; ")}.` : "";
      this.tablesNews.value = {
        text: `Other numbers or names in ${counted(tables, "saved table")} now.${kept}${lost}`,
        others,
      };
    });
  }

  /** Names what was confirmed, each segment alone; the news says what could not be named. */
  async nameHits(name: string): Promise<void> {
    const hits = this.confirmed.value;
    this.naming.value = true;
    const done = await this.trying(async () => {
      const { named, left } = await this.api.nameHits({ name, hits: hits.map(spanOf) });
      const lost = left.length ? ` Not named: ${left.join("; ")}.` : "";
      this.news.value = `${named} of ${hits.length} named, in the tables beside their recordings.${lost}`;
    });
    this.naming.value = false;
    if (!done) this.problem.value = `Not saved: ${this.problem.value}`;
    else await this.searchAgain();
  }

  /** Searches anew; what was said of the hits before is forgotten. */
  async ask(question: Question): Promise<void> {
    this.verdicts.value = new Map();
    this.news.value = "";
    this.tab.value = "search";
    this.hits.value = [];
    await this.search(question);
  }

  /** The same question with what was confirmed and refused as examples and counter-examples. */
  async refine(): Promise<void> {
    const asked = this.question.value;
    if (!asked) return;
    const like = [...asked.like, ...this.confirmed.value.map(spanOf)];
    await this.search({ ...asked, like, unlike: this.refused.value.map(spanOf) }, asked);
  }

  async searchAgain(): Promise<void> {
    if (this.question.value) await this.search(this.question.value);
  }

  /** Says of a hit whether it is right; the same again takes that back. */
  judge(hit: LibraryHit, right: boolean): void {
    const verdicts = new Map(this.verdicts.value);
    if (verdicts.get(keyOf(hit))?.right === right) verdicts.delete(keyOf(hit));
    else verdicts.set(keyOf(hit), { hit, right });
    this.verdicts.value = verdicts;
    this.news.value = ""; // it was of others
  }

  clusterName(cluster: number): string {
    return this.state.value?.clusters.find((each) => each.cluster === cluster)?.label ?? "";
  }

  private async search(question: Question, shown = question): Promise<void> {
    const mine = ++this.asked;
    this.question.value = shown;
    this.searching.value = true;
    await this.trying(async () => {
      const { like, unlike, cluster } = question;
      const found = await this.api.search({
        like,
        unlike,
        ...(cluster === undefined ? {} : { cluster }),
        threshold: this.threshold.value,
        mirror: this.mirror.value,
        top: 60,
      });
      if (mine === this.asked) this.hits.value = found.hits;
    });
    if (mine === this.asked) this.searching.value = false;
  }

  /** Clusters of hits have other names, or are others, after an edit. */
  private relabel(): void {
    this.hits.value = this.hits.value.map((hit) => ({
      ...hit,
      label: this.clusterName(hit.cluster),
    }));
  }

  private hitsOf(verdict: boolean): LibraryHit[] {
    return [...this.verdicts.value.values()]
      .filter(({ right }) => right === verdict)
      .map(({ hit }) => hit);
  }

  private async trying(work: () => Promise<unknown>): Promise<boolean> {
    try {
      await work();
      this.problem.value = "";
      return true;
    } catch (error) {
      const newer = error instanceof Refused && error.status === 409;
      if (!newer) this.problem.value = explain(error);
      return false;
    }
  }
}

function spanOf({ recording, start_s, stop_s }: LibraryHit): Span {
  return { recording, start_s, stop_s };
}
