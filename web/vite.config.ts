import { defineConfig } from 'vite';
import { addresses } from './addresses.js';
import { offline } from './offline.js';

export default defineConfig({
  // The base is relative, so that the page works under any address.
  base: './',
  // The largest chunk, three.js, may exceed the default limit of 500 kB, because it is loaded only for the robot in 3D.
  build: { target: 'es2022', outDir: 'dist', emptyOutDir: true, reportCompressedSize: false, chunkSizeWarningLimit: 700 },
  plugins: [addresses(), offline()],
  // The page imports the simulated chip from tools/judge.
  server: { fs: { allow: ['..'] } },
});
