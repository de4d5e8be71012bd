/** A number field that shows what is typed until Enter or leaving it; Escape restores the value. */
import { useSignal } from "@preact/signals";
import type { JSX } from "preact";

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
  // While the field has the focus it shows the draft, whatever happens to the value meanwhile.
  const draft = useSignal<string | null>(null);
  return (
    <input
      {...rest}
      type="number"
      class="number"
      aria-label={label}
      value={draft.value ?? value}
      onFocus={(event) => (draft.value = event.currentTarget.value)}
      onInput={(event) => (draft.value = event.currentTarget.value)}
      onChange={(event) => {
        const number = event.currentTarget.valueAsNumber;
        if (draft.value !== null && Number.isFinite(number)) onNumber(number);
      }}
      onBlur={() => (draft.value = null)}
      onKeyDown={(event) => {
        if (event.key === "Escape") {
          draft.value = null;
          event.currentTarget.value = String(value);
        }
        if (event.key === "Enter" || event.key === "Escape") event.currentTarget.blur();
      }}
    />
  );
}
