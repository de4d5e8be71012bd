/** Edit a preset's parameter with a number field and a slider. */
import type { JSX } from "preact";
import { NumberInput } from "../../layout/NumberInput";
import type { Parameter } from "../../messages";

export function ParameterSlider(props: {
  parameter: Parameter;
  value: number;
  change: (value: number) => void;
}): JSX.Element {
  const { parameter, value, change } = props;
  const { name, help, minimum, maximum, step, unit } = parameter;
  const title = name.replaceAll("_", " ");
  return (
    <div class="parameter" title={help}>
      <label for={`parameter-${name}`}>
        {title} <span class="quiet">{unit}</span>
      </label>
      <NumberInput
        label={unit ? `${title} in ${unit}` : title}
        min={minimum}
        max={maximum}
        step={roundToThreeDigits(step)}
        value={roundToThreeDigits(value)}
        onNumber={change}
      />
      <input
        id={`parameter-${name}`}
        type="range"
        min={minimum}
        max={maximum}
        step={step}
        value={value}
        onInput={(event) => change(event.currentTarget.valueAsNumber)}
      />
    </div>
  );
}

function roundToThreeDigits(value: number): number {
  return Number(value.toFixed(3));
}
