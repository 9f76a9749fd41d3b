import { render } from 'preact';
import { App } from './app';
import { missing } from './support';
import './style/studio.css';

const place = document.getElementById('app')!;
const lacks = missing();
if (lacks === null) {
  render(<App />, place);
} else {
  render(
    <main class="sorry">
      <h1>Snell Studio</h1>
      <p>{lacks}</p>
    </main>,
    place,
  );
}
