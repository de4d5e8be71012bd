/** What the page tells people in passing: one line of news, and problems that stay until read. */

import { signal } from "@preact/signals";

const READING_TIME = 6000; // milliseconds

export interface News {
  text: string;
  undo?: (() => void) | undefined;
}

export class Bulletin {
  readonly news = signal<News | null>(null);
  readonly problems = signal<string[]>([]);
  private timer = 0;

  /** Takes the place of earlier news, and goes by itself. */
  tell(text: string, undo?: () => void): void {
    this.news.value = { text, undo };
    window.clearTimeout(this.timer);
    this.timer = window.setTimeout(() => (this.news.value = null), READING_TIME);
  }

  problem(text: string): void {
    if (!this.problems.value.includes(text)) this.problems.value = [...this.problems.value, text];
  }

  dismiss(text: string): void {
    this.problems.value = this.problems.value.filter((each) => each !== text);
  }
}
