// TetGen's own time and memory: the linker sends the library's call of TetGen here (--wrap in cmake/benchmarks.cmake).
#include "measured.h"

#include <tetgen.h>

// The linker's names for the function that the library calls and for TetGen's own.
#define PW_TETGEN_CALL _Z14tetrahedralizeP14tetgenbehaviorP8tetgenioS2_S2_S2_
#define PW_JOINED(a, b) a##b
#define PW_NAME(prefix, call) PW_JOINED(prefix, call)

extern "C" {
void PW_NAME(__real_, PW_TETGEN_CALL)(tetgenbehavior*, tetgenio*, tetgenio*, tetgenio*, tetgenio*);
void PW_NAME(__wrap_, PW_TETGEN_CALL)(tetgenbehavior*, tetgenio*, tetgenio*, tetgenio*, tetgenio*);
}

namespace partwheel::bench {

TetgenWatch& tetgen_watch() {
    static TetgenWatch watch;
    return watch;
}

}  // namespace partwheel::bench

void PW_NAME(__wrap_, PW_TETGEN_CALL)(tetgenbehavior* how, tetgenio* in, tetgenio* out, tetgenio* added, tetgenio* sizes) {
    using namespace partwheel::bench;
    struct Booking {  // also when TetGen throws
        Seconds began = Seconds::now();
        ~Booking() {
            TetgenWatch& watch = tetgen_watch();
            watch.seconds += Seconds::now() - began;
            watch.peak_memory = peak_memory();
            ++watch.calls;
        }
    } const booking;
    PW_NAME(__real_, PW_TETGEN_CALL)(how, in, out, added, sizes);
}
