# SPDX-License-Identifier: GPL-3.0-or-later
"""How well similar and mirrored parts are found from one part in hand: precision and recall against people's segments.

usage: similar.py MESH_DIR SEG_DIR [--people N] [--jobs N]

The truth for one segment of a person's: those others of that person that a rigid alignment (alike.py, not our code)
brings onto it, up to alike.NEAR; of those that come a little less near, up to alike.FAR, people differ, and so they
count neither as right nor as wrong in the second figure. The part in hand is the stop of the wheel that overlaps the
segment most, of four clicks on it; segments that no stop overlaps by half have no part to begin with and are counted
apart. A part that was found is right if it overlaps a segment that is alike by half, by area, and no other did. Figures are
of all that was found and wanted, where a person who cuts a table's legs into twenty pieces counts a hundred times one who
cuts four legs, and as means over clicks.

Mirrored: in models that are their own mirror image, of segments whose mirror image is another segment of that person's
(by half), the share for which that is among what is found, one part for each of the model's planes.
"""

import argparse
import os
from concurrent.futures import ProcessPoolExecutor
from pathlib import Path

import alike
import numpy as np
from mirror import mirror_faces, triangle_areas
from psb import Mode, build

from partwheel import likeness

CATEGORIES = {"glasses": 41, "ant": 81, "chair": 101, "octopus": 121, "table": 141, "teddy": 161, "hand": 181}
CLICKS = 4
HALF = 0.5
FIGURES = ("right", "wrong", "unclear", "wanted", "answers", "precise", "clicks", "recalled", "mirrored", "mirrors",
           "without")


class Model:
    def __init__(self, path):
        self.mesh, self.hierarchy = build(path, Mode.LEARNED)
        self.area = np.bincount(self.mesh.faces, triangle_areas(self.mesh), self.mesh.face_count)
        self.sums = np.concatenate([[0], np.cumsum(self.area[self.hierarchy.order])])
        surface = self.mesh.vertices, self.mesh.triangles, self.mesh.faces
        self.measured = likeness.measure_nodes(self.hierarchy, *surface)
        self.image, self.surface, self.known = mirror_faces(self.mesh), surface, {}

    def overlaps(self, inside):
        """(N,) of each node with a set of faces, by area."""
        first, last = self.hierarchy.first, self.hierarchy.last
        prefix = np.concatenate([[0], np.cumsum((self.area * inside)[self.hierarchy.order])])
        common = prefix[last] - prefix[first]
        return common / (self.sums[last] - self.sums[first] + prefix[-1] - common)

    def in_hand(self, inside, overlaps):
        weights = self.area * inside
        faces = np.random.default_rng(0).choice(len(weights), CLICKS, p=weights / weights.sum())
        stops = np.unique(np.concatenate([self.hierarchy.wheel(int(face))[0] for face in faces]))
        best = int(stops[overlaps[stops].argmax()])
        return best if overlaps[best] >= HALF else None

    def similar(self, node):
        if node not in self.known:
            ranked = likeness.similar_parts(self.hierarchy, self.measured, node)
            self.known[node] = [other for other, value in ranked if value >= likeness.THRESHOLD]
        return self.known[node]

    def mirrored(self, node):
        return [image.node for image in likeness.mirrored_parts(self.hierarchy, *self.surface, node)]


def figures(path, segmentations):
    """{name: number} of FIGURES, of one model."""
    model, count = Model(path), dict.fromkeys(FIGURES, 0)
    for file in segmentations:
        labels = np.loadtxt(file, int)
        kept_labels, distances = alike.distances(model.mesh, labels)
        insides = [labels == label for label in kept_labels]
        overlaps = np.array([model.overlaps(inside) for inside in insides])
        for number, inside in enumerate(insides):
            like = distances[number] <= alike.NEAR
            image = None if model.image is None else _image(model, insides, number)
            if not like.any() and image is None:
                continue
            node = model.in_hand(inside, overlaps[number])
            if node is None:
                count["without"] += 1
                continue
            if like.any():
                _count(count, overlaps[:, model.similar(node)], like, distances[number] <= alike.FAR)
            if image is not None:
                count["mirrors"] += 1
                count["mirrored"] += (overlaps[image][model.mirrored(node)] >= HALF).any()
    return count


def _count(count, overlaps, like, near):
    hit, wrong = set(), 0
    for overlap in overlaps.T:
        best = int(overlap.argmax())
        if overlap[best] >= HALF and like[best] and best not in hit:
            hit.add(best)
        elif overlap[best] >= HALF and near[best] and not like[best]:
            count["unclear"] += 1
        else:
            wrong += 1
    count["right"] += len(hit)
    count["wrong"] += wrong
    count["wanted"] += int(like.sum())
    count["clicks"] += 1
    count["recalled"] += len(hit) / like.sum()
    if hit or wrong:
        count["answers"] += 1
        count["precise"] += len(hit) / (len(hit) + wrong)


def _image(model, insides, number):
    """The number of the segment that is a segment's mirror image, or None."""
    reflected = insides[number][model.image]
    shares = [(model.area * (reflected & other)).sum() / (model.area * (reflected | other)).sum() for other in insides]
    best = int(np.argmax(shares))
    return best if best != number and shares[best] >= HALF else None


def shares(count):
    """(strict precision, precision, recall, the last two as means over clicks, mirrored); nan of nothing."""
    with np.errstate(invalid="ignore", divide="ignore"):
        right, wrong = np.float64(count["right"]), count["wrong"]
        return (right / (right + wrong + count["unclear"]), right / (right + wrong),
                right / count["wanted"], np.float64(count["precise"]) / count["answers"],
                np.float64(count["recalled"]) / count["clicks"], np.float64(count["mirrored"]) / count["mirrors"])


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("meshes", type=Path)
    parser.add_argument("segmentations", type=Path)
    parser.add_argument("--people", type=int, default=4, help="how many people's segments of each model")
    parser.add_argument("--jobs", type=int, default=os.cpu_count())
    parser.add_argument("--categories", nargs="*", default=list(CATEGORIES))
    parser.add_argument("--models", type=int, default=20, help="at most so many of each category")
    args = parser.parse_args()
    rows = {}
    with ProcessPoolExecutor(args.jobs) as pool:
        for name in args.categories:
            models = [CATEGORIES[name] + k for k in range(20) if (args.meshes / f"{CATEGORIES[name] + k}.off").exists()]
            rows[name] = [pool.submit(figures, args.meshes / f"{model}.off",
                                      sorted((args.segmentations / str(model)).glob("*.seg"))[:args.people])
                          for model in models[:args.models]]
        print("| category | precision, strictly | precision | recall | precision, by click | recall, by click | mirrored | "
              "segments without a part |")
        print("|---|---|---|---|---|---|---|---|")
        table = []
        for name, pending in rows.items():
            counts_of = [future.result() for future in pending]
            count = {key: sum(counts[key] for counts in counts_of) for key in FIGURES}
            table.append(shares(count))
            print(f"| {name} |", " | ".join(f"{share:.3f}" for share in table[-1]), f"| {count['without']} |", flush=True)
        print("| **mean** |", " | ".join(f"**{share:.3f}**" for share in np.nanmean(table, axis=0)), "| |")


if __name__ == "__main__":
    main()
