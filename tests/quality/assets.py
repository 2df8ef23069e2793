# SPDX-License-Identifier: GPL-3.0-or-later
"""Artists' models as data for fit.py: every large shell of an asset as it is, and assets fused to one closed surface.

SCORE: the folder of score.py, which says what an asset holds and what its targets are: shells, patches of one material, and
bone subtrees. A target counts for a shell if more than half of it lies there.
"""

import sys
import zlib
from pathlib import Path

import numpy as np

# Assets by maker's pack, for cross-validation. Two characters by Kay Lousberg begin with kaykit_.
PACKS = {
    "aircraft": "Commercial_Airplane MilitaryAirplane2 Military_Airplane Private_plane SmallPlane",
    "animals": "Cat Cow Dog Elk Horse Llama Pig Pug Sheep Wolf Zebra Eagle",
    "dinosaurs": "Apatosaurus Parasaurolophus Stegosaurus Trex Triceratops Velociraptor",
    "fish": "Dolphin Fish1 Fish2 Fish3 Manta_ray Piranha Shark Whale",
    "people": "Animated_Woman Animated_Woman_smooth Cop Female_Alternative Female_Casual Female_Dress Female_TankTop "
              "KnightCharacter Robot kaykit_Barbarian kaykit_Knight",
    "cars": "Ambulance BasicCar Bus CopCar Cop_SUV NormalCar1 NormalCar2 RaceCar SUV SchoolBus SimpleCarHigh SimpleCarShort "
            "SportsCar Taxi Bicycle SquareFrameBicycle",
    "ships": "Boat BoatWSail CruiseShip Lifeboat Sail_ship Viking_boat",
    "tanks": "Tank Tank2 Tank3 Tank4",
    "guns": "Gun P90 Pistol Revolver Rifle Shotgun SniperRifle",
    "medieval weapons": "Arrow Axe Axe_Double Axe_Small Bow_Evil Bow_Golden Club Katana ShortSword Sword PirateSword Helmet1 "
                        "Helmet2 Helmet3 ShoulderPads Cannon Brass_Telescope",
    "buildings": "Bank Flat Flat2 Hospital House House2 Igloo Igloo2",
    "furniture": "BedDouble BedTwin Bookcase Bookcase_Books Chair Closet ChestAnimated Christmas_Tree",
}
MIN_SHELL = 0.1  # of the area: smaller shells are single parts, see small_shell in dendrogram.h
CLICKS = 5  # for each target


class Asset:
    """The targets of one closed surface. labels (T, F): 2 t + 1 in target t, 2 t elsewhere; kinds (T,); clicks: (face, label).

    A click has several correct answers, of different sizes: all targets that contain it.
    """

    def __init__(self, name, pack, vertices, triangles, targets):
        self.name, self.pack = name, pack
        self.vertices, self.triangles = vertices, triangles
        a, b, c = (vertices[triangles[:, k]] for k in range(3))
        self.area = np.linalg.norm(np.cross(b - a, c - a), axis=1) / 2
        self.kinds = [kind for kind, _ in targets]
        self.labels = np.array([2 * t + mask for t, (_, mask) in enumerate(targets)])
        self.ends = [2 * t for t in range(len(targets) + 1)]
        rng = np.random.default_rng(zlib.crc32(name.encode()))
        self.clicks = np.array([(face, 2 * t + 1) for t, (_, mask) in enumerate(targets) for face in rng.choice(
            np.flatnonzero(mask), CLICKS, p=self.area[mask] / self.area[mask].sum())])


def _select(score, targets, areas, faces):
    """[(kind, mask of `faces`)]: the targets of which more than half is in these faces, as large there as score.py asks."""
    result = {}
    for kind, _, mask in targets:
        inside, (low, high) = mask[faces], score.KINDS[kind]
        share = areas[faces][inside].sum() / areas[faces].sum()
        if low < share < high and areas[faces][inside].sum() > 0.5 * areas[mask].sum():
            result.setdefault(inside.tobytes(), (kind, inside))
    return list(result.values())


def _pack_of(name):
    return next(pack for pack, names in PACKS.items() if name in names.split())


def read_assets(score_dir, directory, fused):
    """[Asset] of all models in `directory` that have targets."""
    sys.path.insert(0, str(score_dir))
    import score
    from marks import fused_targets

    result = []
    for path in sorted(Path(directory).glob("*.npz")):
        model = np.load(path, allow_pickle=False)
        vertices, triangles = model["V"].astype(float), model["F"].astype(np.int64)
        areas = score.areas(vertices, triangles)
        if fused:
            targets = [(kind, mask) for kind, _, mask in fused_targets(score, model, areas)]
            if targets:
                result.append(Asset(f"{path.stem}_fused", _pack_of(path.stem), vertices, triangles, targets))
            continue
        welded, targets = score.welded(vertices, triangles), score.targets(model)
        places = np.zeros((welded.max() + 1, 3))
        places[welded] = vertices[triangles]
        shells = score.shells(welded)
        shares = np.bincount(shells, areas) / areas.sum()
        for number, shell in enumerate(np.argsort(-shares, kind="stable")[:np.count_nonzero(shares > MIN_SHELL)]):
            faces = np.flatnonzero((shells == shell) & (areas > 0))
            if of_shell := _select(score, targets, areas, faces):
                used, corners = np.unique(welded[faces], return_inverse=True)
                result.append(Asset(f"{path.stem}_{number}", _pack_of(path.stem), places[used], corners.reshape(-1, 3), of_shell))
    return result
