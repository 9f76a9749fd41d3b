/** Can the engine run in this browser? */

/** A module of one function that uses a vector of 128 bit: valid just where `simd128` is known. */
const VECTOR = new Uint8Array([
  0, 97, 115, 109, 1, 0, 0, 0, 1, 5, 1, 96, 0, 1, 123, 3, 2, 1, 0, 10, 10, 1, 8, 0, 65, 0, 253, 15, 253, 98, 11,
]);

/** What is missing, in words; `null` if nothing is. */
export function missing(): string | null {
  if (typeof WebAssembly !== 'object' || typeof WebAssembly.validate !== 'function') {
    return 'This browser has no WebAssembly, with which Snell computes its pictures. Any browser of recent years has it, unless it was switched off in the settings.';
  }
  if (!WebAssembly.validate(VECTOR)) {
    return 'This browser does not know the vector instructions (SIMD) of WebAssembly that Snell computes with. Chrome and Edge from 91, Firefox from 89 and Safari from 16.4 do.';
  }
  return null;
}

/** In place of the studio. */
export function Sorry({ lacks }: { lacks: string }) {
  return (
    <main class="sorry">
      <h1>Snell Studio</h1>
      <p>{lacks}</p>
    </main>
  );
}
