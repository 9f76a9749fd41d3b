/** A page that is zoomed to 200 %: its views are low and not wide. */

import { expect, test } from 'vitest';
import { finished, OUT, studio } from './page';

const { on } = studio();

for (const fragment of ['#tour/5', '#exercise/bend']) {
  test(`at 200 % the question of ${fragment} is seen beside both views`, () =>
    on(
      fragment,
      async (page) => {
        await finished(page);
        await page.getByRole('button', { name: 'Through the camera' }).waitFor();
        const { innerWidth, innerHeight, ...places } = await page.evaluate(() => {
          const placeOf = (selector: string) => {
            const { left, top, right, bottom } = document.querySelector(selector)!.getBoundingClientRect();
            return { left, top, right, bottom };
          };
          const { innerWidth, innerHeight } = window;
          return { innerWidth, innerHeight, picture: placeOf('.picture'), drawing: placeOf('.drawing'), question: placeOf('.tour p:nth-of-type(2)') };
        });
        for (const [name, { left, top, right, bottom }] of Object.entries(places)) {
          expect([left >= 0, top >= 0, right <= innerWidth, bottom <= innerHeight], name).toEqual([true, true, true, true]);
        }
        const { picture, drawing, question } = places;
        expect([picture.right <= drawing.left + 1, drawing.right <= question.left]).toEqual([true, true]);
        // Large enough to be used.
        for (const view of [picture, drawing]) expect(Math.min(view.right - view.left, view.bottom - view.top)).toBeGreaterThan(180);
        await page.screenshot({ path: `${OUT}zoomed-${fragment.slice(1, 5)}.png` });
      },
      { viewport: { width: 720, height: 430 }, deviceScaleFactor: 2 },
    ));
}
