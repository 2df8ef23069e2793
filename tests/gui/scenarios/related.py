"""From the part in hand to others: Shift Ctrl L selects those that are alike, the wheel takes more and fewer, Esc takes
it back; the panel of the last operation changes the threshold; Shift Ctrl F adds the part on the other side."""


def play(stage):
    yield from stage.open("homer")
    stage.use_tool()
    likeness = stage.part("related.similar_parts").find_similar

    def has_its_like(spot):
        hierarchy = stage.registry.get_hierarchy(stage.snapshot(stage.object))
        stops, start = hierarchy.wheel(spot[2])
        ranked = likeness(stage.snapshot(stage.object), hierarchy, int(stops[start]))
        return ranked and ranked[0].likeness > 0.7

    spots = (stage.spot(x, 0.5, above=1) for x in (0.05, 0.95, 0.2, 0.8, 0.35, 0.65))
    yield from stage.take(next(spot for spot in spots if has_its_like(spot)), "to be used", notches=0)
    arm = stage.selection()
    pick = stage.part("parts.picks").get_pick
    stage.shortcut("mesh.partwheel_similar")
    yield from stage.until("the alike ones are selected", lambda: len(stage.selection()) > len(arm))
    hierarchy, node = pick(stage.snapshot(stage.object)).hierarchy, pick(stage.snapshot(stage.object)).node
    similar = likeness(stage.snapshot(stage.object), hierarchy, node)

    def faces(count):
        """Of the part and so many more."""
        return arm.union(*(hierarchy.faces(similar_part.node).tolist() for similar_part in similar[:count]))

    count = next(count for count in range(len(similar) + 1) if stage.selection() == faces(count))
    stage.check(1 <= count < len(similar), f"{count} of {len(similar)} parts are alike")
    stage.bar_fits((yield from stage.screenshot("similar")))
    for notches in (1, -1, -1):
        count += notches
        stage.mouse.wheel(notches)
        yield from stage.selected(faces(count), f"after {notches} notches")
    stage.mouse.key("ESC")
    yield from stage.selected(arm, "after Esc")

    stage.shortcut("mesh.partwheel_similar")
    yield from stage.until("they are selected again", lambda: len(stage.selection()) > len(arm))
    stage.mouse.key("RET")
    yield from stage.ended()
    stage.check(stage.last.bl_idname == "MESH_OT_partwheel_similar", "there is its panel")
    yield from stage.adjusted(threshold=(similar[0].likeness + 1) / 2)
    yield from stage.selected(arm, "with a higher threshold")
    stage.mouse.key("Z", ctrl=True)
    yield from stage.selected(arm, "after Ctrl Z")

    stage.shortcut("mesh.partwheel_mirrored")
    other = frozenset(hierarchy.faces(stage.part("related.similar_parts").find_mirror_images(stage.snapshot(stage.object), hierarchy, node)[0].node).tolist())
    yield from stage.selected(arm | other, "on both sides")
    yield from stage.screenshot("mirrored")
    stage.mouse.key("Z", ctrl=True)
    yield from stage.selected(arm, "after Ctrl Z")
