// The second rung: the source mended, its crossing parts united.
#include "repair.h"

#include "attach.h"
#include "mend.h"

namespace partwheel {

Surface repair(const Surface& source, Progress& progress) {
    const Mended mended = mend(source, progress);
    if (mended.sheets > 0) throw Error(PW_ERROR_OPEN, "The mesh has open parts that can't be closed. Give them a thickness.");
    Surface surface = to_surface(source, mended.mesh);
    check_surface(surface, progress);
    attach(source, surface, progress);
    surface.rung = PW_RUNG_REPAIRED;
    surface.account = "Repaired: " + mended.done.account() + ".";
    return surface;
}

}  // namespace partwheel
