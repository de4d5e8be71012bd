/** Dark or light: what the system says, until the user chooses. */
import { computed, effect, signal } from "@preact/signals";

export type Theme = "dark" | "light";

const media = matchMedia("(prefers-color-scheme: dark)");
const system = signal<Theme>(media.matches ? "dark" : "light");
const chosen = signal<Theme | null>(null);

media.addEventListener("change", () => (system.value = media.matches ? "dark" : "light"));

export const theme = computed<Theme>(() => chosen.value ?? system.value);

// Canvases read the variables right after this, so it must not wait for the next picture.
effect(() => document.documentElement.setAttribute("data-theme", theme.value));

export function toggleTheme(): void {
  chosen.value = theme.value === "dark" ? "light" : "dark";
}

/** The value of a variable of the style sheet, for canvases; follows the theme. */
export function cssColor(name: string): string {
  void theme.value; // whoever asks is told when it changes
  return getComputedStyle(document.documentElement).getPropertyValue(`--${name}`).trim();
}
