// A minimal bcryptprimitives.dll for Wine 8, in which it is missing. Rust's standard library gets its random bytes from
// ProcessPrng.
#include <windows.h>
#include <ntsecapi.h>

__declspec(dllexport) BOOL WINAPI ProcessPrng(PBYTE bytes, SIZE_T count) { return RtlGenRandom(bytes, (ULONG)count); }
