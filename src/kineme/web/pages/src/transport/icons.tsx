/** Draw icon buttons in the text's colour. */
import type { JSX } from "preact";
import { Button } from "../layout/controls";
import { theme, toggleTheme } from "../theme";

const PATHS = {
  play: "M4 2.5v11l9-5.5z",
  pause: "M4 2.5h3v11H4zM9 2.5h3v11H9z",
  back: "M11.5 2.5v11L4.5 8z",
  on: "M4.5 2.5v11l7-5.5z",
  before: "M2.5 2.5h2v11h-2zM13 2.5v11L5.5 8z",
  after: "M11.5 2.5h2v11h-2zM3 2.5v11l7.5-5.5z",
  loop: "M4 4.5h6.5V2l4 3.5-4 3.5V6.5H5.5v2h-2V5zM12 11.5H5.5V14l-4-3.5 4-3.5v2.5h5v-2h2V11z",
  minus: "M3 7h10v2H3z",
  plus: "M7 3h2v4h4v2H9v4H7V9H3V7h4z",
  fit: "M2 3h2v10H2zM12 3h2v10h-2zM5 8l2.5-2.5v1.7h1V5.5L11 8l-2.5 2.5V8.8h-1v1.7z",
  full: "M2 2h5v2H4v3H2zM9 2h5v5h-2V4H9zM2 9h2v3h3v2H2zM12 9h2v5H9v-2h3z",
  theme: "M8 2a6 6 0 1 0 0 12zM8 2a6 6 0 1 1 0 12v-1.4a4.6 4.6 0 1 0 0-9.2z",
} as const;

export type IconName = keyof typeof PATHS;

export function Icon({ name }: { name: IconName }): JSX.Element {
  return (
    <svg width="16" height="16" viewBox="0 0 16 16" fill="currentColor" aria-hidden="true">
      <path d={PATHS[name]} />
    </svg>
  );
}

interface ButtonProps {
  icon: IconName;
  /** Accessible name and tooltip. */
  label: string;
  keys?: string;
  pressed?: boolean;
  disabled?: boolean;
  onClick: () => void;
}

export function IconButton({
  icon,
  label,
  keys,
  pressed,
  disabled,
  onClick,
}: ButtonProps): JSX.Element {
  return (
    <Button
      class="icon"
      aria-label={label}
      title={keys ? `${label} (${keys})` : label}
      disabled={disabled ?? false}
      onClick={onClick}
      {...(pressed === undefined ? {} : { "aria-pressed": pressed })}
    >
      <Icon name={icon} />
    </Button>
  );
}

/** Render a button that switches between the dark and the light theme. */
export function ThemeButton(): JSX.Element {
  const other = theme.value === "dark" ? "light" : "dark";
  return <IconButton icon="theme" label={`Show the page ${other}`} onClick={toggleTheme} />;
}
