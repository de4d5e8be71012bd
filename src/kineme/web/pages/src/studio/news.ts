/** What the page tells people in passing: one line of news, and problems that stay until read. */

import { effect, signal, untracked } from "@preact/signals";
import { explain } from "./server/answers";

const READING_TIME = 6000; // milliseconds

export interface News {
  text: string;
  /** The table that was in front: once it is another, this is no news any more. */
  of: string;
  /** Whether it says why something was not done. */
  refused: boolean;
}

export interface Problem {
  text: string;
  about: string;
}

export class Bulletin {
  readonly news = signal<News | null>(null);
  readonly problems = signal<Problem[]>([]);
  private timer = 0;

  /** @param inFront which table is looked at; reads signals */
  constructor(private readonly inFront: () => string) {
    effect(() => {
      const { value: news } = this.news;
      if (news && news.of !== inFront()) this.news.value = null;
    });
  }

  /** Takes the place of earlier news, and goes by itself. */
  tell(text: string, refused = false): void {
    this.news.value = { text, of: untracked(this.inFront), refused };
    window.clearTimeout(this.timer);
    this.timer = window.setTimeout(() => (this.news.value = null), READING_TIME);
  }

  /** Says why something was not done. */
  refuse(text: string): void {
    this.tell(text, true);
  }

  /** `about` is what did not work: the problem goes once that has worked. */
  problem(text: string, about: string): void {
    const others = this.problems.value.filter((each) => each.text !== text);
    this.problems.value = [...others, { text, about }];
  }

  solved(about: string): void {
    if (this.problems.value.some((each) => each.about === about))
      this.problems.value = this.problems.value.filter((each) => each.about !== about);
  }

  /** Does something; whether it worked. What went wrong stays until it has worked. */
  async attempt(about: string, work: () => Promise<unknown>): Promise<boolean> {
    try {
      await work();
      this.solved(about);
      return true;
    } catch (error) {
      this.problem(explain(error), about);
      return false;
    }
  }

  /** Takes one away that has been read; the last one, where none is named. */
  dismiss(text = this.problems.value.at(-1)?.text): void {
    this.problems.value = this.problems.value.filter((each) => each.text !== text);
  }
}
