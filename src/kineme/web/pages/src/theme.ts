/** Dark or light: what the system says, until the user chooses. */
import { computed, effect, signal } from "@preact/signals";

export type Theme = "dark" | "light";

const media = matchMedia("(prefers-color-scheme: dark)");
const system = signal<Theme>(media.matches ? "dark" : "light");
const chosen = signal<Theme | null>(null);
/** While the page is being printed. */
export const onPaper = signal(false);

media.addEventListener("change", () => (system.value = media.matches ? "dark" : "light"));

export const theme = computed<Theme>(() =>
  onPaper.value ? "light" : (chosen.value ?? system.value),
);

// Canvases read the variables right after this, so it must not wait for the next picture.
effect(() => document.documentElement.setAttribute("data-theme", theme.value));

export function toggleTheme(): void {
  chosen.value = theme.value === "dark" ? "light" : "dark";
}

/** A colour of the style sheet for canvases, `#rrggbb` (or `rgba(…)`); follows the theme. */
export function cssColor(name: string): string {
  const key = `${theme.value} ${name}`; // whoever asks is told when the theme changes
  let color = colors.get(key);
  if (color === undefined) {
    const style = getComputedStyle(document.documentElement);
    pen.fillStyle = style.getPropertyValue(`--${name}`).trim();
    color = String(pen.fillStyle); // spelled out, however short the style sheet has it
    colors.set(key, color);
  }
  return color;
}

const colors = new Map<string, string>();
const pen = new OffscreenCanvas(1, 1).getContext("2d")!;
