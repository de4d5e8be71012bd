/**
 * Print pages in light colours. Canvases are redrawn at once, since a printing browser draws no
 * further frames. 3-D canvases would be empty, so images replace them.
 */
import { isPrinting } from "../theme";
import { ticker } from "../ticker";

export function startPrinting(): void {
  const images: HTMLImageElement[] = [];
  addEventListener("beforeprint", () => {
    isPrinting.value = true;
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
    isPrinting.value = false;
    for (const image of images.splice(0)) image.remove();
  });
}
