/** Full screen: the stage, how to play it, and the timeline. */
export function toggleFullScreen(): void {
  if (document.fullscreenElement) void document.exitFullscreen();
  else void document.querySelector(".layout")?.requestFullscreen();
}
