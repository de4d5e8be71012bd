/** Some of a list, for something that is done with them at once. */
import { useSignal } from "@preact/signals";
import type { JSX } from "preact";
import { Dialog } from "../dialogs/Dialog";
import { Button, Checkbox, toggled } from "../../layout/controls";

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

  return (
    <Dialog title={title} close={close}>
      <p>{say}</p>
      <ul class="choice-list">
        {choices.map(({ value, text, picture }) => (
          <li key={value}>
            <Checkbox
              checked={chosen.value.has(value)}
              onCheck={() => (chosen.value = toggled(chosen.value, value))}
            >
              {text}
              {picture}
            </Checkbox>
          </li>
        ))}
      </ul>
      <Button
        class="primary"
        disabled={!n || n > most}
        onClick={() => void choose([...chosen.value]).then(close)}
      >
        {action} {n || ""}
      </Button>
    </Dialog>
  );
}
