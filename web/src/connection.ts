// The socket to the server; it reconnects when the connection is lost.
import { type Command, type Frame, type Text, type Topology, decode } from "./protocol";

export interface Listener {
  text(message: Text): void;
  topology(topology: Topology): void;
  frame(frame: Frame): void;
  connected(is: boolean): void;
  fault(message: string): void;
}

const FIRST_WAIT = 300; // [ms]
const LONGEST_WAIT = 4000;

export class Connection {
  private socket: WebSocket | null = null;
  private wait = FIRST_WAIT;

  constructor(private readonly listener: Listener) {
    this.open();
  }

  send(command: Command): boolean {
    if (this.socket?.readyState !== WebSocket.OPEN) return false;
    this.socket.send(JSON.stringify(command));
    return true;
  }

  private open(): void {
    const socket = new WebSocket(`ws://${location.host}/live${location.search}`);
    socket.binaryType = "arraybuffer";
    this.socket = socket;
    socket.onopen = () => {
      this.wait = FIRST_WAIT;
      this.listener.connected(true);
    };
    socket.onmessage = (event) => {
      try {
        this.hear(event.data as string | ArrayBuffer);
      } catch (error) {
        this.listener.fault(String(error instanceof Error ? error.message : error));
      }
    };
    socket.onclose = () => {
      this.listener.connected(false);
      setTimeout(() => this.open(), this.wait);
      this.wait = Math.min(2 * this.wait, LONGEST_WAIT);
    };
  }

  private hear(data: string | ArrayBuffer): void {
    if (typeof data === "string") {
      this.listener.text(JSON.parse(data) as Text);
      return;
    }
    const message = decode(data);
    if (message.kind === "topology") this.listener.topology(message);
    else this.listener.frame(message);
  }
}
