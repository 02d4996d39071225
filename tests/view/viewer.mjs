// A Foxglove client (@foxglove/ws-protocol) of a server. query: of its URL, such as 'newest'.
import protocol from '@foxglove/ws-protocol';
import WebSocket from 'ws';

export function connect(url, query = '') {
  const address = new URL(url);
  address.protocol = 'ws:';
  if (query) address.searchParams.set(query, '');
  return new protocol.FoxgloveClient({ws: new WebSocket(address, ['foxglove.sdk.v1', protocol.FoxgloveClient.SUPPORTED_SUBPROTOCOL])});
}
