/** Edit a number; Enter or leaving the field saves it, Escape restores it. */
import type { JSX } from "preact";
import { useDraft } from "./useDraft";

interface Props {
  value: number;
  label?: string;
  min?: number;
  max?: number;
  step?: number | "any";
  id?: string;
  /** Called with a finite number when the field is left or Enter is pressed. */
  onNumber: (value: number) => void;
}

export function NumberInput({ value, label, onNumber, ...rest }: Props): JSX.Element {
  const draft = useDraft(String(value), (text) => {
    const number = Number(text);
    if (text.trim() && Number.isFinite(number)) onNumber(number);
  });
  return <input {...rest} type="number" class="number" aria-label={label} {...draft} />;
}
