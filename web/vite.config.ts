import { defineConfig } from 'vite';

export default defineConfig({
  // Relative, so that the folder works under any address.
  base: './',
  build: { target: 'es2022', outDir: 'dist', emptyOutDir: true, reportCompressedSize: false },
  // The simulated chip is the judge's.
  server: { fs: { allow: ['..'] } },
});
