/** What the edits on their way will make of the table that was confirmed, without doing it twice. */
import type { Recording } from "../../messages";
import type { IdentifiedTable } from "./identities";
import { expected, isSame, storyOf, withPresent, type Story } from "./story";
import type { Unsent } from "./unsent";

/** A story, and what it was told of: the table of a revision. */
interface Latest {
  of: Recording["segmentation"];
  story: Story;
}

export class Outlook {
  private latest: Latest | null = null;
  /** By the name of an edit: what it made of what. */
  private readonly made = new Map<string, { from: Story; to: Story | null }>();

  /** The table once all these edits are made; those that cannot be foreseen change nothing yet. */
  after(confirmed: Recording, unsent: readonly Unsent[]): IdentifiedTable {
    return this.stories(confirmed, unsent).at(-1)!.present;
  }

  /** Whether there is an edit among them of which only the server knows what it makes. */
  isOpen(confirmed: Recording, unsent: readonly Unsent[]): boolean {
    this.stories(confirmed, unsent);
    return unsent.some(({ name }) => this.made.get(name)?.to === null);
  }

  /** Whether the last of these edits is one that cannot be made. */
  isHopeless(confirmed: Recording, unsent: readonly Unsent[]): boolean {
    const [before, after] = this.stories(confirmed, unsent).slice(-2);
    return before === after && this.made.get(unsent.at(-1)!.name)?.to !== null;
  }

  /**
   * The server has made an edit of a table; `now` is what it made. Where that is what was foreseen,
   * the table that is shown stays the one it is: nothing that follows from it is done again.
   */
  confirm({ name, edit }: Unsent, before: Recording, now: Recording): Recording {
    const from = this.storyAt(before);
    const table: IdentifiedTable = { segmentation: now.segmentation, ids: now.ids ?? [] };
    const next = now.revision === before.revision + 1;
    const step = this.made.get(name);
    this.made.delete(name);
    const guess = next && step?.from === from ? step.to : null;
    const made = next ? withPresent(from, edit, table) : storyOf(table);
    const story = guess && isSame(guess.present, table) ? guess : made;
    const { segmentation, ids } = story.present;
    this.latest = { of: segmentation, story };
    return { ...now, segmentation, ids: [...ids] };
  }

  /** Where the edits lead, one after the other, from what is confirmed on. */
  private stories(confirmed: Recording, unsent: readonly Unsent[]): Story[] {
    const stories = [this.storyAt(confirmed)];
    for (const { name, edit } of unsent) {
      const from = stories.at(-1)!;
      let step = this.made.get(name);
      if (step?.from !== from) {
        step = { from, to: expected(from, edit, name) };
        this.made.set(name, step);
      }
      stories.push(step.to ?? from);
    }
    return stories;
  }

  /** A table that came from elsewhere has no story. */
  private storyAt({ segmentation, ids = [] }: Recording): Story {
    if (this.latest?.of !== segmentation)
      this.latest = { of: segmentation, story: storyOf({ segmentation, ids }) };
    return this.latest.story;
  }
}
