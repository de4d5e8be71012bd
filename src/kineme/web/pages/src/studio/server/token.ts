/**
 * The token, which tabs tell each other.
 *
 * A server that is started anew has a new one, and so has the tab it opens.
 * Tabs of the old server, which may hold unsent edits, go on with it.
 */
import { tokenToAddress } from "./address";
import { Api, Refused } from "./api";

/** Tells other tabs the token if it is good, and takes theirs if its own no longer is. */
export function shareToken(api: Api): void {
  const channel = new BroadcastChannel("kineme.token");
  const isGood = (token: string): Promise<boolean> =>
    new Api(token)
      .state()
      .then(() => true)
      .catch((error: unknown) => !(error instanceof Refused));
  channel.onmessage = async ({ data: token }: MessageEvent<string>) => {
    if (token === api.token || (await isGood(api.token)) || !(await isGood(token))) return;
    api.token = token;
    tokenToAddress(token);
  };
  channel.postMessage(api.token);
}
