/** Show messages: one line of news, and problems that stay until dismissed. */
import { effect, signal, untracked } from "@preact/signals";
import { explainError } from "./server/api";

const READING_TIME = 6000; // milliseconds

interface News {
  text: string;
  /** Key of the active table; the news disappears when it changes. */
  of: string;
  /** Whether it explains why something was not done. */
  refused: boolean;
}

interface Problem {
  text: string;
  about: string;
}

export class Notifications {
  readonly news = signal<News | null>(null);
  readonly problems = signal<Problem[]>([]);
  private timer = 0;

  /** @param getTableKey returns a key of the active table; reads signals */
  constructor(private readonly getTableKey: () => string) {
    effect(() => {
      const { value: news } = this.news;
      if (news && news.of !== getTableKey()) this.news.value = null;
    });
  }

  /** Show news for some seconds, replacing earlier news. */
  tell(text: string, refused = false): void {
    this.news.value = { text, of: untracked(this.getTableKey), refused };
    window.clearTimeout(this.timer);
    this.timer = window.setTimeout(() => (this.news.value = null), READING_TIME);
  }

  /** Say why something was not done. */
  refuse(text: string): void {
    this.tell(text, true);
  }

  /** Show a problem; `clearProblem(about)` removes it. */
  reportProblem(text: string, about: string): void {
    const others = this.problems.value.filter((each) => each.text !== text);
    this.problems.value = [...others, { text, about }];
  }

  clearProblem(about: string): void {
    if (this.problems.value.some((each) => each.about === about))
      this.problems.value = this.problems.value.filter((each) => each.about !== about);
  }

  /** Run `work` and return whether it succeeded; show or clear its problem. */
  async attempt(about: string, work: () => Promise<unknown>): Promise<boolean> {
    try {
      await work();
      this.clearProblem(about);
      return true;
    } catch (error) {
      this.reportProblem(explainError(error), about);
      return false;
    }
  }

  /** Dismiss a problem, by default the last. */
  dismiss(text = this.problems.value.at(-1)?.text): void {
    this.problems.value = this.problems.value.filter((each) => each.text !== text);
  }
}
