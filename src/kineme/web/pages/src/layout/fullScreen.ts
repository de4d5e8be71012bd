/** Enter or leave full screen. */
export function toggleFullScreen(): void {
  if (document.fullscreenElement) void document.exitFullscreen();
  else void document.querySelector(".layout")?.requestFullscreen();
}
