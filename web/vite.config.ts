import { defineConfig } from 'vite';
import { addresses } from './addresses.js';
import { offline } from './offline.js';

export default defineConfig({
  // Relative, so that the folder works under any address.
  base: './',
  // three.js is one chunk, loaded when the robot is shown in 3D.
  build: { target: 'es2022', outDir: 'dist', emptyOutDir: true, reportCompressedSize: false, chunkSizeWarningLimit: 700 },
  plugins: [addresses(), offline()],
  // Allows imports of the simulated chip from tools/judge.
  server: { fs: { allow: ['..'] } },
});
