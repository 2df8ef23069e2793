/* python.exe, for the interpreter in PYTHON, a file beside it. */
#include <stdio.h>
#include <windows.h>

int wmain(int count, wchar_t **arguments)
{
    HMODULE python = LoadLibraryW(PYTHON);
    int (*Py_Main)(int, wchar_t **) = python ? (void *)GetProcAddress(python, "Py_Main") : NULL;
    if (!Py_Main) {
        fprintf(stderr, "The interpreter can't be loaded: error %lu\n", GetLastError());
        return 1;
    }
    return Py_Main(count, arguments);
}
