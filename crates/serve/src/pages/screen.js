// A show over a WebSocket: pictures onto canvases, numbers and words to the given functions. Comes back when the server does.
const AWAY = 'The server does not answer; trying again.';

// Why a handshake was refused. Its status is hidden from a page; that of a plain request is not.
async function refused() {
  try {
    const answer = await fetch('/favicon.ico');
    return answer.ok ? AWAY : (await answer.json()).error;
  } catch { return AWAY; }
}

export class Screen {
  constructor(path, canvases, { onframe, onwords, onlink }) {
    Object.assign(this, { path, canvases, onframe, onwords, onlink, ended: false });
    this.open();
  }

  open() {
    const socket = new WebSocket(`${location.protocol === 'https:' ? 'wss' : 'ws'}://${location.host}${this.path()}`);
    socket.binaryType = 'arraybuffer';
    this.socket = socket;
    // What the server said against this show, and whether it is worth trying again.
    let error = null, opened = false;
    socket.onopen = () => { opened = true; };
    // In the order in which they were sent: decoding a picture takes its time, and words said after it must not come before.
    let turn = Promise.resolve();
    const mine = () => socket === this.socket && !this.ended;
    socket.onmessage = ({ data }) => {
      if (typeof data === 'string') { const words = JSON.parse(data); if (words.kind === 'error') error = words; }
      if (!error && mine()) this.onlink('');
      turn = turn.catch(() => {}).then(() => (mine() ? this.take(data) : null));
    };
    socket.onclose = async () => {
      if (!mine() || (error && !error.again)) return;
      const why = error?.why ?? (opened ? AWAY : await refused());
      if (!mine()) return;
      this.onlink(why);
      setTimeout(() => mine() && this.open(), 1500);
    };
  }

  async take(data) {
    if (typeof data === 'string') {
      const words = JSON.parse(data);
      if (words.kind === 'error') this.onlink(words.why);
      else this.onwords(words);
      return;
    }
    const length = new DataView(data).getUint32(0, true);
    const header = JSON.parse(new TextDecoder().decode(new Uint8Array(data, 4, length)));
    let at = 4 + length;
    const pictures = await Promise.all(header.pictures.map(async ({ view, bytes }) => {
      const blob = new Blob([new Uint8Array(data, at, bytes)], { type: 'image/png' });
      at += bytes;
      return [view, await createImageBitmap(blob)];
    }));
    if (this.ended) return;
    for (const [view, picture] of pictures) {
      const canvas = this.canvases[view];
      if (!canvas) continue;
      if (canvas.width !== picture.width || canvas.height !== picture.height) [canvas.width, canvas.height] = [picture.width, picture.height];
      canvas.getContext('2d').drawImage(picture, 0, 0);
      picture.close();
    }
    this.onframe(header);
    this.ask({ do: 'ack' });
  }

  ask(message) {
    const { socket } = this;
    const send = () => socket.send(JSON.stringify(message));
    if (socket.readyState === WebSocket.OPEN) send();
    // Before the show is there: as soon as it is.
    else if (socket.readyState === WebSocket.CONNECTING) socket.addEventListener('open', send);
  }

  again() {
    const old = this.socket;
    this.open();
    old.close();
  }

  end() {
    this.ended = true;
    this.socket.close();
  }
}
