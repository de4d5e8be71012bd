/**
 * On paper a page is light, whatever it is on the screen. The canvases are drawn anew for it at
 * once, as a browser that prints shows no further picture; what is in 3-D, which it would leave
 * empty, gives its place to an image.
 */
import { onPaper } from "../theme";
import { ticker } from "../ticker";

export function startPrinting(): void {
  const images: HTMLImageElement[] = [];
  addEventListener("beforeprint", () => {
    onPaper.value = true;
    ticker.drawNow();
    for (const canvas of document.querySelectorAll<HTMLCanvasElement>(".viewer canvas")) {
      const image = new Image();
      image.className = "on-paper";
      image.src = canvas.toDataURL();
      canvas.after(image);
      images.push(image);
    }
  });
  addEventListener("afterprint", () => {
    onPaper.value = false;
    for (const image of images.splice(0)) image.remove();
  });
}
