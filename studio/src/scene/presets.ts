/** Clear materials to begin with. */

export interface Preset {
  name: string;
  /** In the engine's catalogue; `null` for what it has no index of in visible light. */
  glass: string | null;
  /** At 587.56 nm, for models without colours: docs/glasses.md has it, and the sources. */
  eta: number;
}

export const PRESETS: Preset[] = [
  { name: 'Water', glass: 'water', eta: 1.3334 },
  { name: 'Quartz glass', glass: 'fused silica', eta: 1.45846 },
  { name: 'Crown glass BK7', glass: 'N-BK7', eta: 1.5168 },
  { name: 'Flint glass SF11', glass: 'SF11', eta: 1.78472 },
  { name: 'Sapphire', glass: 'sapphire', eta: 1.76817 },
  { name: 'Diamond', glass: 'diamond', eta: 2.41749 },
  // In the infrared, where it is clear.
  { name: 'Germanium (infrared)', glass: null, eta: 4 },
];
