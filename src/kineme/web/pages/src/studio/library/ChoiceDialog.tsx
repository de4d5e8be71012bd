/** Choose some entries of a list for one action. */
import { useSignal } from "@preact/signals";
import type { JSX } from "preact";
import { Dialog } from "../dialogs/Dialog";
import { Button, Checkbox, toggleMember } from "../../layout/controls";

interface Props<Value> {
  title: string;
  say: string;
  action: string;
  choices: { value: Value; text: string; picture?: JSX.Element }[];
  /** Maximum number of choices; all by default. */
  most?: number;
  /** Performs the action; returns whether it succeeded. */
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
              onCheck={() => (chosen.value = toggleMember(chosen.value, value))}
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
