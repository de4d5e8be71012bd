/** Some of a list, for something that is done with them at once. */
import { useSignal } from "@preact/signals";
import type { JSX } from "preact";
import { Dialog } from "../dialogs/Dialog";

interface Props<Value> {
  title: string;
  say: string;
  action: string;
  choices: { value: Value; text: string; picture?: JSX.Element }[];
  /** So many may be chosen; all by default. */
  most?: number;
  /** Does it; whether it was done. */
  choose: (chosen: Value[]) => Promise<boolean>;
  close: () => void;
}

export function ChoiceDialog<Value>(props: Props<Value>): JSX.Element {
  const { title, say, action, choices, most = choices.length, choose, close } = props;
  const chosen = useSignal<ReadonlySet<Value>>(new Set());
  const n = chosen.value.size;
  const toggle = (value: Value): void => {
    const next = new Set(chosen.value);
    if (!next.delete(value)) next.add(value);
    chosen.value = next;
  };
  return (
    <Dialog title={title} close={close}>
      <p>{say}</p>
      <ul class="choice-list">
        {choices.map(({ value, text, picture }) => (
          <li key={value}>
            <label>
              <input
                type="checkbox"
                checked={chosen.value.has(value)}
                onChange={() => toggle(value)}
              />{" "}
              {text}
              {picture}
            </label>
          </li>
        ))}
      </ul>
      <button
        type="button"
        class="primary"
        disabled={!n || n > most}
        onClick={() => void choose([...chosen.value]).then(close)}
      >
        {action} {n || ""}
      </button>
    </Dialog>
  );
}
