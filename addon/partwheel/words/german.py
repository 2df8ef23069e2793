# SPDX-License-Identifier: GPL-3.0-or-later
"""German."""

WORDS = {
    "Turn":
        "Drehung",
    "About the border's normal":
        "Um die Normale der Grenze",
    "Depth":
        "Tiefe",
    "How deep the part sinks in, in radii of its border":
        "Wie tief es eingesenkt wird, mal dem Radius seiner Grenze",
    "size {size:.2f}, turn {turn:.0f}°, depth {depth:.2f}":
        "Größe {size:.2f}, Drehung {turn:.0f}°, Tiefe {depth:.2f}",
    "Place Part":
        "Teil platzieren",
    "Place the active part on a surface: it follows the mouse with its border on the surface":
        "Das aktive Teil auf eine Oberfläche setzen: Es folgt der Maus, mit seiner Grenze auf der Oberfläche und nach ihr ausgerichtet",
    "{operator} stopped: the part is no longer the active object.":
        "{operator} wurde beendet: Das Teil ist nicht mehr das aktive Objekt.",
    "Onto":
        "Auf",
    "The object that the part is placed on":
        "Das Objekt, auf das das Teil gesetzt wird",
    "Location":
        "Position",
    "Location of the part's border":
        "Wohin seine Grenze kommt",
    "Normal":
        "Normale",
    "Normal of the surface at the location":
        "Der Oberfläche an dieser Stelle",
    "Size":
        "Größe",
    "Factor of the part's size":
        "Mal der bisherigen Größe",
    "Fit Border":
        "Grenze einpassen",
    "Fit the part to the target's nearest border, where a part was removed":
        "Auf die nächste Grenze des Ziels, wo ein Teil entfernt wurde, und in deren Größe",
    "Mirror Copy":
        "Kopie spiegeln",
    "Add the mirror image across the target's own X axis":
        "Das Spiegelbild an der eigenen X-Achse des Ziels hinzufügen",
    "In Object Mode, make the part that you want to place the active object.":
        "Im Objektmodus das Teil, das platziert werden soll, zum aktiven Objekt machen.",
    "Choose the mesh object to place the part on.":
        "Es muss angegeben werden, auf welches Mesh-Objekt das Teil gesetzt wird.",
    "Move the mouse over a surface":
        "Die Maus über eine Oberfläche bewegen",
    "There is no surface under the mouse yet":
        "Unter der Maus ist noch keine Oberfläche",
    "Onto {name}":
        "Auf {name}",
    "fitted":
        "eingepasst",
    "with mirror copy":
        "mit gespiegelter Kopie",
    "{name} has no border to fit: no part was removed from it.":
        "{name} hat keine Grenze zum Einpassen: Von dort wurde kein Teil entfernt.",
    "Swap with Compatible Part":
        "Gegen passendes Teil tauschen",
    "Exchange the picked part for one of another object that fits its border; the wheel goes through the candidates":
        "Das gewählte Teil gegen eines von einem anderen Objekt tauschen, das zu seiner Grenze passt; das Mausrad geht durch, was es gibt",
    "{operator} stopped: the object is no longer the active one.":
        "{operator} wurde beendet: Das Objekt ist nicht mehr das aktive.",
    "From":
        "Von",
    "The object that the new part comes from; none: the other selected objects, or else all others":
        "Das Objekt, von dem das neue Teil kommt; keines: die ausgewählten, sonst alle anderen",
    "Part":
        "Teil",
    "Number of the new part in its object; -1: the most compatible part":
        "Die Nummer des neuen Teils in diesem Objekt; -1: das am besten passende",
    "Factor of the size at which the borders fit":
        "Mal der Größe, in der die Grenzen passen",
    "Mirror":
        "Spiegeln",
    "Use the part's mirror image":
        "Das Spiegelbild des Teils nehmen",
    "Blend":
        "Überblenden",
    "Width of a smooth transition on either side of the seam, in radii of the seam":
        "Breite eines weichen Übergangs auf beiden Seiten der Naht, mal deren Radius",
    "Find Parts":
        "Teile finden",
    "Find the parts of the new mesh afterwards, in the background":
        "Die Teile des neuen Meshs gleich finden, in einem eigenen Prozess",
    "There is no mesh object {name}.":
        "Es gibt kein Mesh-Objekt {name}.",
    "{name}, part {number} of {count}, {likeness:.0%} similar":
        "{name}, Teil {number} von {count}, zu {likeness:.0%} ähnlich",
    "mirrored":
        "gespiegelt",
    "Leave Edit Mode":
        "Bearbeitungsmodus verlassen",
    "The part is the whole model: nothing would be left to put another part on. Pick a smaller one.":
        "Das Teil ist das ganze Modell: Es bliebe nichts, worauf ein anderes Teil gesetzt werden könnte. Ein kleineres wählen.",
    "The part has no border with the rest of the model, so no other part can be fitted to it. Pick a part that is connected to the rest.":
        "Das Teil hat keine Grenze zum übrigen Modell, also nichts, woran ein anderes Teil passen könnte. Eines wählen, das aus dem Modell herausgewachsen ist, kein Stück für sich.",
    "No other object has parts. Find the parts of the object that the new part comes from, and select this object, too; or paste a part that was copied as a solid.":
        "Kein anderes Objekt hat Teile. Die Teile dessen finden, von dem das neue Teil kommt, und es mit auswählen; oder ein Teil einfügen, das als Volumenkörper kopiert wurde.",
    "No part there has a border that fits the picked part's.":
        "Dort hat kein Teil eine Grenze, die in die von diesem passen würde.",
    "{name} has no part {number}.":
        "{name} hat kein Teil {number}.",
    "That part of {name} has no border that fits the picked part's.":
        "Dieses Teil von {name} hat keine Grenze, die in die von diesem passen würde.",
    "{name} has changed and has other parts now. Start again.":
        "{name} wurde geändert und hat jetzt andere Teile. Von vorn beginnen.",
    "it has no faces":
        "es hat keine Flächen",
    "{count} edges don't have exactly two faces":
        "{count} Kanten haben nicht genau zwei Flächen",
    "{count} edges have faces of opposite orientation":
        "an {count} Kanten sind die Flächen gegeneinander gerichtet",
    "{count} vertices are loose or connect parts that only touch there":
        "{count} Vertices sind lose oder verbinden Teile, die sich dort nur berühren",
    "{name} is not a solid: {reason}. Repair it, or copy the part again.":
        "{name} ist kein Volumenkörper: {reason}. Reparieren oder das Teil neu kopieren.",
    "{name} is not a solid: it is inside out. Turn its faces outside (Recalculate Outside).":
        "{name} ist kein Volumenkörper: Innen ist außen. Die Flächen nach außen wenden (Normalen nach außen neu berechnen).",
    "by {solver} within: {reason}":
        "mit {solver}, innen: {reason}",
    "by {solver}: {reason}":
        "mit {solver}: {reason}",
    "{one} and {other} can't be united ({reasons}). Move one of them a little: overlapping coplanar faces are the usual cause.":
        "{one} und {other} können nicht vereinigt werden ({reasons}). Eines ein wenig bewegen: Meist liegt es an Flächen, die ineinander liegen.",
    "its volume would be {share:.0%} of the sum of both volumes":
        "sein Volumen wäre {share:.0%} von dem der beiden",
    "one of them is missing":
        "eines der beiden wurde ausgelassen",
    "In Object Mode, select the parts, and then the mesh object to unite them with.":
        "Im Objektmodus die Teile auswählen, danach das Mesh-Objekt, zu dem sie gehören sollen.",
    "Unite Solids":
        "Volumenkörper vereinigen",
    "Unite the other selected solids with the active one into a single closed mesh":
        "Die anderen ausgewählten Volumenkörper mit dem aktiven zu einem einzigen geschlossenen Mesh vereinigen",
    "Width of a smooth transition on either side of each seam, in radii of the seam; 0: the seam stays a crease":
        "Breite eines weichen Übergangs auf beiden Seiten jeder Naht, mal deren Radius; 0: Die Naht bleibt ein Knick",
    "Find the parts of the united mesh afterwards, in the background":
        "Die Teile des vereinigten Meshs gleich finden, in einem eigenen Prozess",
    "Keep Parts":
        "Teile behalten",
    "Keep the other objects":
        "Die anderen Objekte lassen, wie sie sind",
    "{name} is now one closed mesh with {count:,} faces (solver {solver}).":
        "{name} ist jetzt ein geschlossenes Mesh aus {count:,} Flächen (Löser {solver}).",
    "The vertex group {name} is locked. Unlock it, or give it another name.":
        "Die Vertex-Gruppe {name} ist gesperrt. Entsperren oder ihr einen anderen Namen geben.",
    "Face Sets":
        "Face Sets",
    "One for each part; they replace the existing ones":
        "Eines für jedes Teil, anstelle aller vorhandenen",
    "Vertex Groups":
        "Vertex-Gruppen",
    "For an armature: smooth across the borders, with a sum of 1":
        "Für eine Armature: Sie fallen weich über die Grenzen ab und ergeben zusammen 1",
    "Colored Materials":
        "Farbige Materialien",
    "A material with a color of its own for each part":
        "Ein Material in eigener Farbe für jedes Teil",
    "Material Slots":
        "Material-Slots",
    "The model's own materials, with a slot for each part":
        "Die eigenen Materialien des Modells, mit einem Slot für jedes Teil",
    "Seams":
        "Nähte",
    "For unwrapping: along the borders, in creases, and where a part would not lie flat":
        "Zum Abwickeln: entlang der Grenzen, in Knicken und wo ein Teil sonst nicht flach läge",
    "Objects":
        "Objekte",
    "Each part becomes an object, parented to its neighbor":
        "Jedes Teil ein Objekt, das am nächsten hängt",
    "Bones":
        "Knochen",
    "An armature with a bone for each part, and its vertex groups, ready to pose":
        "Eine Armature mit einem Knochen für jedes Teil und den Vertex-Gruppen dazu, bereit zum Posieren",
    "For Printing":
        "Zum Drucken",
    "Closed objects with flat cuts, pegs and sockets, checked. Needs manifold3d":
        "Geschlossene Objekte mit ebenen Schnitten, Zapfen und Löchern, geprüft. Braucht manifold3d",
    "Parts to...":
        "Teile zu ...",
    "Divide the whole model into parts: the wheel changes the number, a click and the wheel one part, a drag merges":
        "Das ganze Modell in Teile zerlegen: Das Mausrad ändert, wie viele, ein Klick und das Rad eines, Ziehen vereint",
    "Create":
        "Erstellen",
    "What to create from the parts; none: only save them in the mesh":
        "Was aus den Teilen wird; nichts: Sie werden nur im Mesh gemerkt",
    "Parts":
        "Teile",
    "Number of parts; 0: the parts saved in the mesh, or the automatic segmentation":
        "Wie viele; 0: die im Mesh gemerkten, oder wie Menschen sie am ehesten sehen würden",
    "Closed":
        "Geschlossen",
    "Close the objects where they were cut, so that they are solids that add up to the whole":
        "Die Objekte schließen, wo sie geschnitten wurden: Volumenkörper, die zusammen das Ganze ergeben",
    "Smooth Caps":
        "Glatte Deckel",
    "Close the objects with a smooth surface instead of flat facets":
        "Mit einer glatten Oberfläche schließen statt mit den ebenen Facetten im Inneren, die es vom Rest trennen",
    "Cap Material":
        "Deckel-Material",
    "Give the caps a material of their own":
        "Den Deckeln ein eigenes Material geben",
    "Origins at Borders":
        "Ursprünge an Grenzen",
    "Place the origin of each object at the center of its border":
        "Jedes Objekt dreht sich um die Mitte seiner Grenze",
    "Explode":
        "Explodieren",
    "Distance by which the objects move apart, times the distance of their centers. You can change it later in a custom property of the largest object":
        "Wie weit sie auseinandergerückt werden, im Verhältnis zum Abstand ihrer Mitten. Das größte hat dies auch als benutzerdefinierte Eigenschaft, die sich später ändern lässt",
    "Shell":
        "Schale",
    "Thickness of the walls, by a modifier; 0: solid":
        "Wie dick ihre Wände sind, durch einen Modifikator; 0: massiv",
    "Unwrap":
        "Abwickeln",
    "Unwrap the mesh along the seams, into a new UV map if there are others":
        "Das Mesh entlang der Nähte abwickeln, in eine neue UV-Map, wenn es andere hat",
    "Pegs":
        "Zapfen",
    "Add a peg and a socket across each cut, where there is room":
        "Ein Zapfen und ein Loch an jedem Schnitt, wo Platz ist",
    "Clearance (mm)":
        "Spiel (mm)",
    "The gap around each peg, on all sides":
        "Der Spalt um jeden Zapfen, auf allen Seiten",
    "Wall (mm)":
        "Wand (mm)",
    "Minimum thickness of the walls around a socket; a message reports thinner walls":
        "Was um ein Loch stehen bleibt; dünnere Wände werden gemeldet",
    "Bed (mm)":
        "Druckbett (mm)",
    "Size of the printer's bed: larger parts are split further; 0: no limit":
        "Das des Druckers: Größere Teile werden weiter zerlegt; 0: groß genug",
    "Hide Original":
        "Original ausblenden",
    "Hide the object that was divided":
        "Das zerlegte Objekt ausblenden",
    "This is for an active mesh object, in Object, Edit or Sculpt Mode.":
        "Dies ist für ein aktives Mesh-Objekt, im Objekt-, Bearbeitungs- oder Skulpturmodus.",
    "Dynamic topology changes the faces all the time: turn it off first.":
        "Dynamische Topologie ändert die Flächen ständig: erst abschalten.",
    "These are not parts of {name}: {reason}":
        "Dies sind keine Teile von {name}: {reason}",
    "{name} now has {count} parts: {results}.":
        "{name} ist jetzt in {count} Teilen: {results}.",
    "{count} parts: {results}":
        "{count} Teile: {results}",
    "{count} parts, one of {faces:,} faces: {results}":
        "{count} Teile, eines mit {faces:,} Flächen: {results}",
    "Saved in the Mesh":
        "Im Mesh gemerkt",
    "Printing needs the Python package manifold3d, which Blender doesn't have. To install it, run: {python} -m pip install manifold3d.":
        "Zum Drucken wird das Python-Paket manifold3d gebraucht, das Blender nicht hat. So wird es installiert: {python} -m pip install manifold3d.",
    "The scale of {name} is not uniform: apply its scale first.":
        "{name} ist entlang seiner Achsen verschieden skaliert: erst die Skalierung anwenden.",
    "{name} has {count} UV maps, the most that Blender allows: remove one.":
        "{name} hat {count} UV-Maps, mehr sind nicht möglich: eine entfernen.",
    "Handle of one vertex":
        "Griff aus einem Vertex",
    "Handle of {count:,} vertices":
        "Griff aus {count:,} Vertices",
    "The whole part":
        "Das ganze Teil",
    "Joint of {reach:.1f} radii":
        "Gelenk von {reach:.1f} Radien",
    "The handle covers the whole part, so nothing is left to follow it: make the handle smaller.":
        "Der Griff ist das ganze Teil, nichts bleibt, was ihm folgen könnte: den Griff verkleinern.",
    "One handle covers another: make it smaller or move it.":
        "Ein Griff verdeckt einen anderen: verkleinern oder anderswo setzen.",
    "No visible part of this limb is beyond its joint: make the joint smaller.":
        "Kein Teil dieses Glieds liegt jenseits des Gelenks und ist sichtbar: das Gelenk verkleinern.",
    "Move":
        "Bewegen",
    "Rotate":
        "Rotieren",
    "Scale":
        "Skalieren",
    "{movement} along local {axes}":
        "{movement} entlang lokal {axes}",
    "{movement} along global {axes}":
        "{movement} entlang global {axes}",
    "{movement} in local {axes}":
        "{movement} in lokal {axes}",
    "{movement} in global {axes}":
        "{movement} in global {axes}",
    "Vertex":
        "Vertex",
    "Radius":
        "Radius",
    "Matrix":
        "Matrix",
    "Deform Part":
        "Teil verformen",
    "Drag a handle of the last picked part: the part follows like a soft body, and the rest of the mesh stays in place":
        "Einen Griff des zuletzt gewählten Teils ziehen: Das Teil folgt wie ein weicher Körper, alles jenseits bleibt",
    "Number of the part; -1: the last pick":
        "Die Nummer des Teils; -1: das zuletzt gewählte",
    "Method":
        "Methode",
    "As Rigid as Possible":
        "So starr wie möglich",
    "The part follows the handle and keeps its details":
        "Das Teil folgt dem Griff und behält seine Details",
    "Proportional":
        "Proportional",
    "The part moves as a whole, less toward its border":
        "Das Teil bewegt sich als Ganzes, zu seiner Grenze hin immer weniger",
    "At the Joint":
        "Am Gelenk",
    "The part keeps its shape and turns at its border; the mesh near the border bends":
        "Das Teil behält seine Form und dreht sich um seine Grenze; was ihr auf beiden Seiten nahe ist, biegt sich",
    "Rings":
        "Ringe",
    "Rings of faces around the part that deform with it, for a softer transition":
        "So viele Ringe von Flächen um das Teil verformen sich mit, für einen weicheren Übergang",
    "Joint":
        "Gelenk",
    "Distance from the border within which the mesh bends, in radii of the border":
        "Wie weit von der Grenze des Teils es sich biegt, in Radien der Grenze",
    "Snap Border":
        "Grenze einrasten",
    "Deform the part up to the creases near its border instead of its own border; on for picks with a snapped border":
        "Das Teil bis zu den Knicken nahe seiner Grenze verformen, nicht bis zur eigenen Grenze; wie ein Teil, das so gewählt wurde",
    "Deform parts in Edit Mode of a mesh.":
        "Teile werden im Bearbeitungsmodus eines Meshs verformt.",
    "There is no handle: drag one in the 3D view.":
        "Es gibt keinen Griff: einen in der 3D-Ansicht ziehen.",
    "The mesh doesn't have the vertex of a handle.":
        "Ein Griff ist ein Vertex, den das Mesh nicht hat.",
    "{state}: settling":
        "{state}: kommt zur Ruhe",
    "{state}: getting ready":
        "{state}: wird vorbereitet",
    "Move Part Proportionally":
        "Teil proportional bewegen",
    "Move the last picked part; its surroundings follow, depending on its size. R rotates and S scales it":
        "Das zuletzt gewählte Teil bewegen; seine Umgebung folgt, so weit es seiner Größe entspricht. R rotiert und S skaliert es",
    "The part has no visible vertex inside its border: pick a larger one.":
        "Das Teil hat innerhalb seiner Grenze keinen sichtbaren Vertex: ein größeres wählen.",
    "The part is the whole mesh or a loose piece, without a border that would stay fixed: pick a smaller one, or move it with Blender's own tools.":
        "Das Teil ist das ganze Mesh oder ein loses Stück davon, ohne eine Grenze, die es halten würde: ein kleineres wählen oder es bewegen, wie es ist.",
    "The faces of the part have no area: there is nothing to deform.":
        "Die Flächen des Teils haben keinen Inhalt: Es gibt nichts zu verformen.",
    "This point is not on the part.":
        "Dies ist kein Punkt des Teils.",
    "The mesh of {name} is linked from another file: make it local first (Object > Relations > Make Local).":
        "Das Mesh von {name} ist aus einer anderen Datei verknüpft: erst lokal machen (Objekt > Beziehungen > Lokal machen).",
    "The mesh of {name} is a library override, which Blender does not edit: make it local first (Object > Relations > Make Local).":
        "Das Mesh von {name} ist eine Bibliotheksüberschreibung, die Blender nicht bearbeitet: erst lokal machen (Objekt > Beziehungen > Lokal machen).",
    "This is for an active mesh object, in Edit Mode or Object Mode.":
        "Dies ist für ein aktives Mesh-Objekt, im Bearbeitungs- oder Objektmodus.",
    "The build was canceled.":
        "Die Suche nach Teilen wurde abgebrochen.",
    "The mesh {name} was deleted, so its parts were discarded.":
        "Das Mesh {name} ist nicht mehr da, seine Teile wurden verworfen.",
    "{name} was edited while its parts were being found, so they were discarded. Find them again after editing.":
        "{name} wurde bearbeitet, während seine Teile gesucht wurden, sie wurden verworfen. Erneut suchen, wenn das Mesh ist, wie es sein soll.",
    "The selection is not a part. Pick one with Select Part by Wheel, and confirm it.":
        "Die Auswahl ist kein Teil. Eines mit „Teil per Mausrad auswählen“ wählen und bestätigen.",
    "No part is picked. Pick one with Select Part by Wheel, and confirm it.":
        "Kein Teil ist gewählt. Eines mit „Teil per Mausrad auswählen“ wählen und bestätigen.",
    "There is no part {number}: there are {count}.":
        "Es gibt kein Teil {number}: Es sind {count}.",
    "{name} has no parts for its current mesh. Find them first.":
        "{name} hat keine Teile für sein Mesh, wie es jetzt ist. Erst Teile finden.",
    "The parts saved with {name} come from a newer version of Partwheel, so they are found again. Update Partwheel to use the saved parts.":
        "Die mit {name} gespeicherten Teile sind von einem neueren Partwheel, darum werden sie neu gesucht. Partwheel aktualisieren, um die aus der Datei zu nutzen.",
    "Partwheel finds the parts of {name} after those of {other}":
        "Partwheel findet die Teile von {name} nach denen von {other}",
    "Partwheel finds the parts of {name}: {fraction:.0%}":
        "Partwheel findet die Teile von {name}: {fraction:.0%}",
    "Esc: Cancel":
        "Esc: Abbrechen",
    "Canceled: no parts were found.":
        "Abgebrochen: Es wurden keine Teile gefunden.",
    "To do so, use the panel Partwheel in the sidebar.":
        "Das geht im Panel Partwheel in der Seitenleiste.",
    "No parts for {name}: {reason}":
        "Keine Teile für {name}: {reason}",
    "A method that was tried first failed: {reason}":
        "Ein Weg, der zuerst versucht wurde, ist fehlgeschlagen: {reason}",
    "{name}, {count:,} faces: its parts were found in {seconds:.1f} s.":
        "{name}, {count:,} Flächen: Die Teile wurden in {seconds:.1f} s gefunden.",
    "Quality":
        "Qualität",
    "0 is fastest and right for nearly all meshes. From 1.1 on, the inside is divided more evenly (1.4 is usual, smaller is slower)":
        "0 ist am schnellsten und für fast alles richtig; ab 1,1 wird das Innere gleichmäßiger geteilt (1,4 ist üblich, kleiner ist langsamer)",
    "Exactly":
        "Exakt",
    "Find the parts of a mesh with more than 200,000 triangles at full resolution, not on a coarser copy. Takes about ten times the time and memory. The add-on's preferences can set this for all meshes":
        "Die Teile eines Meshs von mehr als 200.000 Dreiecken auf allen davon finden, nicht auf einer gröberen Kopie: etwa zehnmal so viel Zeit und Speicher. In den Einstellungen des Add-ons geht es für alle",
    "Find Parts of Mesh":
        "Teile des Meshs finden",
    "Find the parts of the active mesh, and of other selected ones that have none, at all sizes for the wheel":
        "Die Teile des aktiven Meshs, und anderer ausgewählter ohne Teile, in allen Größen für das Mausrad finden",
    "Find the parts of a mesh that another operator has just created; that operator stays the last operation, with its panel":
        "Dasselbe für einen Operator, der das Mesh gemacht hat und mit seinem Panel die letzte Operation bleibt",
    "Clear Parts":
        "Teile löschen",
    "The active object has no parts.":
        "Das aktive Objekt hat keine Teile.",
    "Part under the Mouse":
        "Teil unter der Maus",
    "Face Set":
        "Face Set",
    "Mask":
        "Maske",
    "Vertex Group":
        "Vertex-Gruppe",
    "Paint Mask":
        "Malmaske",
    "Part by Wheel":
        "Teil per Mausrad",
    "Pick a part with a click and the mouse wheel, and make it a face set, a mask or a vertex group":
        "Ein Teil mit Klick und Mausrad wählen und es zu einem Face Set, einer Maske oder einer Vertex-Gruppe machen",
    "What the part becomes":
        "Was aus dem Teil wird",
    "A new face set":
        "Ein neues Face Set",
    "Masked against sculpting":
        "Vor dem Modellieren geschützt",
    "Weight 1 in a new vertex group named after the part; Extend adds it to the active group, Deselect removes it from there":
        "Gewicht 1 in einer neuen Vertex-Gruppe mit dem Namen des Teils; mit Erweitern in der aktiven, mit Abwählen dort keines",
    "The only faces that can be painted on":
        "Nur auf diesen Flächen kann gemalt werden",
    "This is for Sculpt Mode and the paint modes of a mesh.":
        "Dies ist für den Skulpturmodus und die Malmodi eines Meshs.",
    "In this mode, parts can't become this: {results}.":
        "Dazu können Teile in diesem Modus nicht werden: {results}.",
    "Face":
        "Fläche",
    "The face that was clicked":
        "Die angeklickte Fläche",
    "Level":
        "Stufe",
    "Notches of the wheel from the part that the click selects; up is positive":
        "Rasten des Mausrads ab dem Teil, das der Klick allein nimmt: aufwärts ist positiv",
    "Extend":
        "Erweitern",
    "Add the part to the selection instead of replacing it":
        "Das Teil zur Auswahl hinzufügen, statt sie zu ersetzen",
    "Deselect":
        "Abwählen",
    "Remove the part from the selection":
        "Das Teil aus der Auswahl nehmen",
    "Move the border of the part into nearby creases":
        "Die Grenze des Teils in die Knicke nahebei verlegen",
    "Face {number} can't be picked: {reason}":
        "Die Fläche {number} kann nicht gewählt werden: {reason}",
    "This 3D view does not show the mesh that is being edited.":
        "Diese 3D-Ansicht zeigt das Mesh nicht, das bearbeitet wird.",
    "Click a face of the mesh":
        "Eine Fläche des Meshs anklicken",
    "The face there was generated by the modifiers of {name} and belongs to no face of its mesh.":
        "Was dort zu sehen ist, haben die Modifikatoren von {name} gemacht, es gehört zu keiner Fläche des Meshs.",
    "The parts are found. Start {operator} again to pick them.":
        "Die Teile sind gefunden. {operator} erneut starten, um sie zu wählen.",
    "Partwheel stopped: the parts were found again. Pick one of them.":
        "Partwheel wurde beendet: Die Teile wurden neu gefunden. Eines davon wählen.",
    "There is no face there":
        "Dort ist keine Fläche",
    "Part {number} of {count}, {faces:,} faces, {share} of the area":
        "Teil {number} von {count}, {faces:,} Flächen, {share} der Oberfläche",
    "border in creases":
        "Grenze in Knicken",
    "Select Part by Wheel":
        "Teil per Mausrad auswählen",
    "Pick a part of the mesh with a click, then make it larger or smaller with the mouse wheel":
        "Ein Teil des Meshs mit einem Klick wählen und dann mit dem Mausrad vergrößern oder verkleinern",
    "Select parts in Edit Mode of a mesh.":
        "Teile werden im Bearbeitungsmodus eines Meshs ausgewählt.",
    "Pick a part of the mesh under the mouse in Object Mode, then enter Edit Mode with the part selected":
        "Ein Teil des Meshs unter der Maus wählen, das dabei bleibt, wie es ist, und dann damit in den Bearbeitungsmodus wechseln",
    "This is for Object Mode.":
        "Dies ist für den Objektmodus.",
    "There is no mesh under the mouse.":
        "Unter der Maus ist kein Mesh.",
    "{name} is an instance, and this 3D view does not show its original: edit it there.":
        "{name} ist eine Instanz, und diese 3D-Ansicht zeigt ihr Original nicht: dort bearbeiten.",
    "Toggle Edit Mode":
        "Bearbeitungsmodus umschalten",
    "Select Part":
        "Teil auswählen",
    "Select a meaningful part of the mesh.\nClick a part, then turn the wheel for the next larger or smaller one. Shift adds, Ctrl removes":
        "Ein sinnvolles Teil des Meshs auswählen.\nEin Teil anklicken, dann mit dem Mausrad zum nächstgrößeren oder -kleineren drehen. Umschalt fügt hinzu, Strg nimmt weg",
    "Parts are found at the first click":
        "Die Teile werden beim ersten Klick gefunden",
    "Pick a meaningful part of a mesh.\nClick a part, then turn the wheel for the next larger or smaller one. Shift adds, Ctrl removes":
        "Ein sinnvolles Teil eines Meshs aufnehmen.\nEin Teil anklicken, dann mit dem Mausrad zum nächstgrößeren oder -kleineren drehen. Umschalt fügt hinzu, Strg nimmt weg",
    "Mask a meaningful part of the mesh, or make it a face set.\nClick a part, then turn the wheel for the next larger or smaller one. Shift adds, Ctrl removes":
        "Ein sinnvolles Teil des Meshs maskieren oder zu einem Face Set machen.\nEin Teil anklicken, dann mit dem Mausrad zum nächstgrößeren oder -kleineren drehen. Umschalt fügt hinzu, Strg nimmt weg",
    "Make a meaningful part of the mesh a vertex group.\nClick a part, then turn the wheel for the next larger or smaller one. Shift adds, Ctrl removes":
        "Ein sinnvolles Teil des Meshs zu einer Vertex-Gruppe machen.\nEin Teil anklicken, dann mit dem Mausrad zum nächstgrößeren oder -kleineren drehen. Umschalt fügt hinzu, Strg nimmt weg",
    "Paint only on a meaningful part of the mesh.\nClick a part, then turn the wheel for the next larger or smaller one. Shift adds, Ctrl removes":
        "Nur auf einem sinnvollen Teil des Meshs malen.\nEin Teil anklicken, dann mit dem Mausrad zum nächstgrößeren oder -kleineren drehen. Umschalt fügt hinzu, Strg nimmt weg",
    "Select all parts that a box touches, at the level of the last pick.\nShift adds, Ctrl removes. A click picks a part as with Select Part":
        "Alle Teile auswählen, die ein Rechteck berührt, um so viele Rasten wie das zuletzt gewählte Teil.\nUmschalt fügt hinzu, Strg nimmt weg. Ein Klick wählt ein Teil wie bei Teil auswählen",
    "Select all parts that a lasso touches, at the level of the last pick.\nShift adds, Ctrl removes. A click picks a part as with Select Part":
        "Alle Teile auswählen, die ein Lasso berührt, um so viele Rasten wie das zuletzt gewählte Teil.\nUmschalt fügt hinzu, Strg nimmt weg. Ein Klick wählt ein Teil wie bei Teil auswählen",
    "Select all parts (segments, regions) that a box touches, at the level of the last pick":
        "Alle Teile (Segmente, Regionen) auswählen, die ein Rechteck berührt, um so viele Rasten wie das zuletzt gewählte Teil",
    "Select all parts (segments, regions) that a lasso touches, at the level of the last pick":
        "Alle Teile (Segmente, Regionen) auswählen, die ein Lasso berührt, um so viele Rasten wie das zuletzt gewählte Teil",
    "Select Parts by Box":
        "Teile per Rechteck auswählen",
    "Select Parts by Lasso":
        "Teile per Lasso auswählen",
    "Select the whole parts that a gesture touched":
        "Aus dem, was eine Geste ausgewählt hat, die ganzen Teile machen, die sie berührt hat",
    "Mode":
        "Modus",
    "Set":
        "Setzen",
    "Select these parts and nothing else":
        "Diese Teile auswählen und sonst nichts",
    "Add these parts to the selection":
        "Zur Auswahl hinzufügen",
    "Subtract":
        "Abziehen",
    "Remove these parts from the selection":
        "Von der Auswahl wegnehmen",
    "Parts: Store Selection":
        "Teile: Was ausgewählt ist",
    "Whole Parts":
        "Ganze Teile",
    "Store the current selection":
        "Merken, was ausgewählt ist",
    "Pick Part by Wheel":
        "Teil per Mausrad aufnehmen",
    "Pick a part of the mesh under the mouse to copy, swap or divide it; it is also selected in Edit Mode":
        "Ein Teil des Meshs unter der Maus aufnehmen, um es zu kopieren, zu tauschen oder zu teilen; im Bearbeitungsmodus ist es ausgewählt",
    "A mask in Sculpt Mode, a vertex group in Weight Paint, else a paint mask":
        "Eine Maske im Skulpturmodus, eine Vertex-Gruppe beim Malen von Gewichten, sonst eine Malmaske",
    "When the wheel resizes the part, after a click with the tool":
        "Wann das Mausrad das Teil größer und kleiner macht, nach einem Klick mit dem Werkzeug",
    "At the Click":
        "Beim Klick",
    "While the mouse stays at the click; elsewhere the wheel zooms as usual":
        "Solange die Maus dort ist, wo geklickt wurde; überall sonst zoomt es wie immer",
    "Until Enter":
        "Bis zur Eingabetaste",
    "Wherever the mouse is, until Enter or another key ends it":
        "Wo immer die Maus ist, bis die Eingabetaste oder eine andere Taste es beendet",
    "Buttons":
        "Knöpfe",
    "Show two buttons beside the click, larger and smaller. With a pen they are always shown":
        "Neben dem Klick zwei Knöpfe zeigen, größer und kleiner. Mit einem Stift sind sie immer da",
    "Blender would not undo a mask of the multires modifier's levels. Make the part a face set instead: the tool's header and the menu Face Sets have it.":
        "Blender würde eine Maske auf den Stufen des Multires-Modifikators nicht rückgängig machen. Machen Sie das Teil stattdessen zu einem Face Set: Die Kopfzeile des Werkzeugs und das Menü Face Sets haben das.",
    "Overlay":
        "Overlay",
    "The vertex group {name} is locked. Unlock it, or pick the part alone: it gets a group of its own.":
        "Die Vertex-Gruppe {name} ist gesperrt. Entsperren oder das Teil allein wählen: Es bekommt eine eigene Gruppe.",
    "{name} has no vertex group that the part could be removed from.":
        "{name} hat keine Vertex-Gruppe, aus der das Teil genommen werden könnte.",
    "The part was removed from the vertex group {name}.":
        "Das Teil wurde aus der Vertex-Gruppe {name} genommen.",
    "The part was added to the vertex group {name}.":
        "Das Teil wurde zur Vertex-Gruppe {name} hinzugefügt.",
    "The part is the new vertex group {name}.":
        "Das Teil ist die neue Vertex-Gruppe {name}.",
    "Find on Import":
        "Beim Import finden",
    "Find the parts of imported and appended meshes at once, while you keep working":
        "Die Teile von Importiertem oder Angehängtem werden sofort gefunden, neben der eigenen Arbeit",
    "Find Parts of Imported Meshes":
        "Teile importierter Meshes finden",
    "Find the parts of newly imported meshes":
        "Die Teile der ausgewählten Meshes, die keine haben, für den Import finden, der sie brachte",
    "Select meshes without parts, in Object Mode.":
        "Dies ist für ausgewählte Meshes ohne Teile, im Objektmodus.",
    "Save Parts in .blend Files":
        "Teile in .blend-Dateien speichern",
    "Save the parts of meshes with the file, so that they need not be found again. The file grows by about 40 bytes per face":
        "Gefundene Teile sind wieder da, wenn die Datei geöffnet wird. Sie wächst um etwa 40 Byte je Fläche",
    "How the next builds merge small parts into larger ones":
        "Wie ab jetzt kleine Teile zu größeren verbunden werden",
    "As People See Them":
        "Wie Menschen sie sehen",
    "Learned from the parts that people chose on some hundred models: a click alone finds the intended part more often. Borders follow creases, and symmetric models get symmetric parts":
        "Nach dem, was Menschen bei einigen hundert Modellen für Teile hielten: Ein Klick allein findet öfter das gemeinte Teil. Grenzen liegen in Knicken, und die beiden Seiten eines spiegelgleichen Modells sind gleich",
    "Nearly Convex":
        "Nahezu konvex",
    "By convexity alone, the most regular and fastest method: a click selects the smallest part, and each notch of the wheel takes one step":
        "Nur nach Konvexität, am regelmäßigsten und schnellsten: Ein Klick nimmt das kleinste Stück, jede Raste des Mausrads geht einen Schritt weiter",
    "Large Meshes at Full Resolution":
        "Große Meshes exakt",
    "Find the parts of meshes with more than 200,000 triangles at full resolution, not on a coarser copy. Takes about ten times the time and memory, for mostly the same parts":
        "Die Teile von Meshes mit mehr als 200.000 Dreiecken auf allen davon finden, nicht auf einer gröberen Kopie: etwa zehnmal so viel Zeit und Speicher für meist dieselben Teile",
    "Memory":
        "Speicher",
    "Share of the available memory that a build may use (enforced on Linux)":
        "Wie viel des verfügbaren Speichers eine Suche nach Teilen nutzen darf (unter Linux eingehalten)",
    "Time Limit":
        "Zeitlimit",
    "Minutes of processor time after which a build is stopped. 0: two, plus two for each 60,000 triangles, far more than builds need":
        "Minuten Prozessorzeit, nach denen eine Suche abgebrochen wird; 0: zwei, und zwei weitere je 60.000 Dreiecke, weit mehr als nötig",
    "Python":
        "Python",
    "The Python 3 program that runs builds in a separate process. Empty: the one in Blender, or else an installed one":
        "Das Programm, mit dem Teile gefunden werden, ein Python 3, in einem eigenen Prozess; leer: das von Blender mitgebrachte, sonst ein installiertes",
    "Tint the picked part":
        "Das gehaltene Teil einfärben",
    "Next Part":
        "Nächstes Teil",
    "Tint faintly what the next notch of the wheel adds":
        "Schwach einfärben, was die nächste Raste des Mausrads hinzufügt",
    "Convex Hull":
        "Konvexe Hülle",
    "Show the convex hull of the picked part as glass":
        "Die konvexe Hülle des gehaltenen Teils als Glas zeigen",
    "All Parts":
        "Alle Teile",
    "Show all parts of the mesh at the size of the picked part, each in its own color":
        "Die Teile des ganzen Meshs in der Größe des gehaltenen zeigen, jedes in einer eigenen Farbe",
    "Pie Menu":
        "Kreismenü",
    "The part has no mirror image in {name}: it crosses the symmetry plane, or the model is not symmetric.":
        "Das Teil hat kein Spiegelbild in {name}: Es liegt quer zur Symmetrieebene, oder das Modell ist nicht auf beiden Seiten gleich.",
    "Remember parts in Edit Mode of a mesh.":
        "Teile werden im Bearbeitungsmodus eines Meshs gemerkt.",
    "Name of the remembered part":
        "Der Name, unter dem es gemerkt ist",
    "Remember Part":
        "Teil merken",
    "Name the last picked part (segment, region), so that you can select it again from the panel's list":
        "Dem zuletzt gewählten Teil (Segment, Region) einen Namen geben, unter dem die Liste im Panel es wieder auswählt",
    "Name":
        "Name",
    "The part's name":
        "Der Name des Teils",
    "Part {number}":
        "Teil {number}",
    "Select Remembered Part":
        "Gemerktes Teil auswählen",
    "Select the remembered part. Shift adds it to the selection, Ctrl removes it":
        "Das unter diesem Namen gemerkte Teil auswählen. Umschalt fügt es zur Auswahl hinzu, Strg nimmt es weg",
    "Rename Part":
        "Teil umbenennen",
    "Rename a remembered part":
        "Einem gemerkten Teil einen anderen Namen geben",
    "New Name":
        "Neuer Name",
    "New name of the part":
        "Der Name des Teils ab jetzt",
    "Forget Part":
        "Teil vergessen",
    "Forget a remembered part; the mesh does not change":
        "Den Namen eines Teils vergessen; das Mesh bleibt, wie es ist",
    "Enter a name for the part.":
        "Ein Teil wird unter einem Namen gemerkt: Er darf nicht leer sein.",
    "The name {name} is too long: use at most {count} letters, fewer in some scripts.":
        "{name} ist als Name zu lang: Er kann {count} Buchstaben haben, in manchen Schriften weniger.",
    "There already is a remembered part {name}. Enter another name, or forget that part first.":
        "Ein Teil ist schon als {name} gemerkt. Einen anderen Namen geben oder jenes erst vergessen.",
    "Add to the selection instead of replacing it":
        "Zur Auswahl hinzufügen, statt sie zu ersetzen",
    "Select Similar Parts":
        "Ähnliche Teile auswählen",
    "Select all parts (segments, regions) similar to the last pick, in all edited objects: fingers, legs, horns":
        "Alle Teile (Segmente, Regionen) wie das zuletzt gewählte auswählen, in jedem Objekt, das bearbeitet wird: Finger, Beine, Hörner",
    "Not searched, since they have no parts yet: {names}. Find their parts first.":
        "Nicht durchsucht, da dort noch keine Teile bekannt sind: {names}. Erst Teile finden.",
    "Threshold":
        "Schwellenwert",
    "Minimum similarity of selected parts: 1 is the same shape and size; lower values select more parts":
        "Wie ähnlich Teile sind, die ausgewählt werden: 1 ist gleiche Form und Größe, weniger ergibt mehr Teile",
    "{count} parts, similarity at least {threshold:.2f}":
        "{count} Teile, ab {threshold:.2f} ähnlich",
    "Select Mirrored Part":
        "Gespiegeltes Teil auswählen",
    "Select the part (segment, region) on the other side of the model, across its own plane of symmetry":
        "Das Teil (Segment, Region) auf der anderen Seite des Modells auswählen, über dessen eigene Symmetrieebene",
    "Plane":
        "Ebene",
    "Number of the symmetry plane, the best one first":
        "Von den Ebenen, an denen das Modell sein eigenes Spiegelbild ist, die beste zuerst",
    "Move the border of the part to the creases nearby, as far as the inside of the model allows":
        "Die Grenze des Teils in die Knicke nahebei verlegen, so weit das Innere es zulässt",
    "Close the part with a smooth surface instead of flat facets":
        "Das Teil mit einer glatten Oberfläche schließen statt mit den ebenen Facetten im Inneren, die es vom Rest trennen",
    "Copy Part as Solid":
        "Teil als Volumenkörper kopieren",
    "Copy the picked part as a solid: a new object, closed where it was cut; Ctrl C, Ctrl V take it to other files":
        "Das gewählte Teil als Volumenkörper kopieren: ein neues Objekt, geschlossen, wo es geschnitten wurde; Strg C, Strg V bringen es in andere Dateien",
    "Remove Part":
        "Teil entfernen",
    "Remove the picked part from the mesh and close the hole":
        "Das gewählte Teil aus dem Mesh nehmen und das Loch schließen",
    "Split into Solids":
        "In Volumenkörper zerlegen",
    "Make each part of a cut a separate object: closed solids that fit each other exactly":
        "Jedes Teil einer Zerlegung zu einem eigenen Objekt machen: geschlossene Volumenkörper, die genau aneinander passen",
    "By":
        "Nach",
    "What decides where to cut":
        "Was entscheidet, wo geschnitten wird",
    "Number of parts; the last merges are undone":
        "In so viele Teile, die zuletzt verbundenen",
    "Number of parts; as nearly convex as possible in total":
        "In so viele Teile, die zusammen am ehesten konvex sind",
    "Height":
        "Höhe",
    "Into the largest parts of at most this concavity":
        "In die größten Teile von höchstens dieser Konkavität",
    "How many parts":
        "Wie viele Teile",
    "Largest concavity of a part: the volume between it and its convex hull":
        "Größte Konkavität eines Teils: das Volumen zwischen ihm und seiner konvexen Hülle",
    "Distance by which the parts move apart, times their distance from the center":
        "Wie weit die Teile auseinandergerückt werden, im Verhältnis zu ihrem Abstand von der Mitte",
    "Hide the object that was split":
        "Das zerlegte Objekt ausblenden",
    "This part has no faces of the mesh. Choose a larger one.":
        "Dieses Teil hat keine Fläche des Meshs. Ein größeres nehmen.",
    "This part can't be closed: its border crosses itself. Choose a larger or smaller one.":
        "Dieses Teil kann nicht geschlossen werden: Seine Grenze kreuzt sich. Ein größeres oder kleineres nehmen.",
    "Face Set from Part by Wheel":
        "Face Set aus Teil per Mausrad",
    "Mask from Part by Wheel":
        "Maske aus Teil per Mausrad",
    "Vertex Group from Part by Wheel":
        "Vertex-Gruppe aus Teil per Mausrad",
    "Paint Mask from Part by Wheel":
        "Malmaske aus Teil per Mausrad",
    "Parts as Solids":
        "Teile als Volumenkörper",
    "Deform":
        "Verformen",
    "Drag a Handle":
        "Einen Griff ziehen",
    "Turn at the Joint":
        "Am Gelenk drehen",
    "Within the part, proportionally:":
        "Im Teil, proportional:",
    "No parts yet":
        "Noch keine Teile",
    "Parts are stored in the file":
        "Teile kamen mit der Datei",
    "Vertices have moved since: you can recompute the parts":
        "Seitdem wurden Vertices bewegt: Die Teile können neu berechnet werden",
    "The mesh has changed: the next use finds its parts again":
        "Das Mesh wurde geändert: Seine Teile werden bei der nächsten Nutzung neu gefunden",
    "From the mesh as it is":
        "Aus dem Mesh, wie es ist",
    "Repaired copy, {off} off":
        "Repariert, {off} daneben",
    "Points on it, {off} off":
        "Aus Punkten, {off} daneben",
    "Coarser copy, {off} off":
        "Vergröbert, {off} daneben",
    "Partwheel":
        "Partwheel",
    "Find at Full Resolution":
        "Exakt finden",
    "Recompute":
        "Neu berechnen",
    "Part: {share} of the area":
        "Teil: {share} der Oberfläche",
    "Parts of {count:,} faces":
        "Teile aus {count:,} Flächen",
    "Part (Segment, Region, Island)":
        "Teil (Segment, Region, Insel)",
    "Path of the Part":
        "Weg des Teils",
    "Show the parts that the wheel goes through, from the smallest to the whole; click one to select it":
        "Die Teile zeigen, durch die das Mausrad geht, vom kleinsten bis zum Ganzen, und per Klick eines nehmen",
    "Remembered Parts":
        "Gemerkte Teile",
    "{operator} stopped: the mesh or its mode has changed.":
        "{operator} wurde beendet: Das Mesh oder sein Modus hat sich geändert.",
    "{operator}: start this with the mouse over a 3D view.":
        "{operator}: mit der Maus über einer 3D-Ansicht starten.",
    "Partwheel stopped: {reason}. The full report is in the system console.":
        "Partwheel wurde beendet: {reason}. Der ganze Bericht steht in der Systemkonsole.",
    "Wheel, ↑↓":
        "Rad, ↑↓",
    "Confirm":
        "Bestätigen",
    "Cancel":
        "Abbrechen",
    "Pick a Part":
        "Teil wählen",
    "Snap":
        "Einrasten",
    "Number":
        "Nummer",
    "Navigate":
        "Navigieren",
    "Drag":
        "Ziehen",
    "Within":
        "Innen",
    "Similar":
        "Ähnliche",
    "Copy":
        "Kopieren",
    "Remove":
        "Entfernen",
    "More, Fewer":
        "Mehr, weniger",
    "Drag or Place the Handle":
        "Griff ziehen oder anderswo setzen",
    "One More":
        "Noch einer",
    "Move, Rotate, Scale":
        "Bewegen, Rotieren, Skalieren",
    "Handle Size":
        "Griffgröße",
    "Wheel":
        "Mausrad",
    "Confirm, Recompute Parts":
        "Bestätigen, Teile neu berechnen",
    "Axis":
        "Achse",
    "Type":
        "Eingeben",
    "Precise":
        "Präzise",
    "Done":
        "Fertig",
    "Shift Wheel":
        "Umschalt Mausrad",
    "Page Up/Down":
        "Bild auf/ab",
    "Next, Previous Part":
        "Nächstes, voriges Teil",
    "Ctrl Wheel":
        "Strg Mausrad",
    "Swap":
        "Tauschen",
    "A Part":
        "Ein Teil",
    "Merge":
        "Vereinen",
    "Join, Split":
        "Verbinden, teilen",
    "Automatic":
        "Automatisch",
    "Groups":
        "Gruppen",
    "Colors":
        "Farben",
    "Slots":
        "Slots",
    "Print":
        "Drucken",
    "Another":
        "Anderes",
    # Of the library
    "This part is no solid: it has no face of the surface. Take a larger one.":
        "Dieses Teil ist kein Volumenkörper: Es hat keine Fläche der Oberfläche. Ein größeres nehmen.",
    "The part has no faces: pick one that has some.":
        "Das Teil hat keine Flächen: eines wählen, das welche hat.",
    "There are no triangles: select a part with faces.":
        "Es gibt keine Dreiecke: ein Teil mit Flächen auswählen.",
    "The part's faces are too thin to be deformed. Dissolve degenerate faces or merge vertices by distance first.":
        "Die Flächen des Teils sind zu dünn zum Verformen. Erst degenerierte Flächen auflösen oder Vertices nach Abstand zusammenführen.",
    "The mesh has no area at all: only edges and points.":
        "Das Mesh hat keinerlei Fläche: nur Kanten und Punkte.",
    "The mesh is a sheet, not a solid: it is open, and closing it would take as much new surface as there is. Give it a thickness (Solidify), close it, or allow open surfaces, which are then taken as thin solids.":
        "Das Mesh ist eine Fläche, kein Volumenkörper: Es ist offen, und es zu schließen bräuchte so viel neue Oberfläche, wie es hat. Verdicken (Solidify), schließen oder offene Oberflächen zulassen, die dann als dünne Volumenkörper gelten.",
    "The surface encloses no volume. Give it some thickness.":
        "Die Oberfläche umschließt kein Volumen. Ihr eine Dicke geben.",
    "There is not enough memory to fill this mesh. Decimate it first.":
        "Der Speicher reicht nicht, um dieses Mesh zu füllen. Erst dezimieren.",
    "The mesh can't be filled: some faces are too close together to be told apart. Merge vertices by distance, or move the parts that almost touch further apart.":
        "Das Mesh kann nicht gefüllt werden: Manche Flächen liegen zu dicht beieinander. Vertices nach Abstand zusammenführen oder was sich fast berührt, weiter auseinanderrücken.",
    "The mesher moved or merged vertices of the surface, for some are too close together. Merge vertices by distance.":
        "Beim Füllen wurden Vertices der Oberfläche verschoben oder vereint, da manche zu dicht beieinander liegen. Vertices nach Abstand zusammenführen.",
    "The mesher lost a part of the surface. Remesh or smooth the mesh a little and try again.":
        "Beim Füllen ging ein Stück der Oberfläche verloren. Remesh anwenden oder das Mesh ein wenig glätten und erneut versuchen.",
    "The mesh has no faces. Choose a mesh object that has some.":
        "Das Mesh hat keine Flächen. Ein Mesh-Objekt wählen, das welche hat.",
    "All vertices are at the same place. Choose a mesh that has an extent.":
        "Alle Vertices liegen am selben Ort. Ein Mesh wählen, das eine Ausdehnung hat.",
    "The mesh has no part that can be closed. Give it a thickness (Solidify).":
        "Das Mesh hat kein Stück, das geschlossen werden kann. Ihm eine Dicke geben (Solidify).",
    "The surface passes through itself in ways that can't be repaired. Remesh it, or unite its parts with a Boolean.":
        "Die Oberfläche durchdringt sich so, dass sie nicht repariert werden kann. Remesh anwenden oder ihre Teile mit einem Boolean vereinigen.",
    "The mesh can't be filled: the mesher comes to no end. Remesh or smooth it a little and try again.":
        "Das Mesh kann nicht gefüllt werden: Das Füllen kommt zu keinem Ende. Remesh anwenden oder ein wenig glätten und erneut versuchen.",
    "The mesh was not changed.":
        "Sonst ist nichts zu Schaden gekommen; das Mesh ist, wie es war.",
    "The build was not done after {seconds} seconds of work and was stopped.":
        "Die Suche war nach {seconds} Sekunden Arbeit nicht fertig und wurde beendet.",
    "The build was not done after {seconds} seconds without any work and was stopped.":
        "Die Suche hat {seconds} Sekunden lang nicht gearbeitet und wurde beendet.",
    "A mesh with fewer faces (Decimate, or a voxel remesh) is faster.":
        "Ein Mesh mit weniger Flächen (Dezimieren oder Voxel-Remesh) ist schneller.",
    "The worker process ran out of memory.":
        "Dem Arbeitsprozess ging der Speicher aus.",
    "It may use {size:.1f} GiB.":
        "Er darf {size:.1f} GiB benutzen.",
    "A mesh with fewer faces (Decimate, or a voxel remesh) needs less.":
        "Ein Mesh mit weniger Flächen (Dezimieren oder Voxel-Remesh) braucht weniger.",
    "Create convex hulls that fit tightly around the model, as children of it, for collisions in game engines":
        "Wenige konvexe Hüllen erzeugen, die das Modell und kaum mehr enthalten: seine Kinder, wie Engines sie zur Kollision wollen",
    "Convex Parts":
        "Konvexe Teile",
    "What decides how many hulls there are":
        "Was bestimmt, wie viele Hüllen es sind",
    "Number of hulls; fewer if more would not improve the fit":
        "So viele Hüllen; weniger, wo mehr nichts brächten",
    "Error":
        "Fehler",
    "As few hulls as possible within this distance from the model":
        "So wenige Hüllen, wie sich finden, die nirgends weiter vom Modell weggehen",
    "Hulls":
        "Hüllen",
    "How many":
        "Wie viele",
    "Largest distance of the hulls from the model, relative to the size of the model":
        "Wie weit Hüllen vom Modell weggehen dürfen: ein Anteil der längsten Strecke quer durch es",
    "Vertices":
        "Vertices",
    "Most vertices of a hull: physics engines accept 64 or 255":
        "Je Hülle, höchstens: Physik-Engines nehmen 64 oder 255",
    "For":
        "Für",
    "How the hulls are named, or what they become":
        "Wie die Hüllen heißen oder was aus ihnen wird",
    "Unreal":
        "Unreal",
    "Godot":
        "Godot",
    "Unity":
        "Unity",
    "Names that start with UCX: the importer uses them as the model's collision":
        "Namen, die mit UCX beginnen: Sein Importer nimmt sie als Kollision des Modells",
    "Names that end with -convcolonly: the importer creates bodies with these shapes":
        "Namen, die mit -convcolonly enden: Sein Importer macht daraus Körper mit Formen",
    "Names with collider, for children that get a convex Mesh Collider":
        "Namen mit collider, für Kinder, die dort einen konvexen Mesh Collider bekommen",
    "Rigid Body":
        "Starrkörper",
    "Blender's rigid body: the model falls and rolls with the hulls as its shape":
        "Blenders eigene: Das Modell fällt und rollt, und seine Hüllen sind seine Form",
    "{name} is linked from another file and can't be a rigid body: make it local first (Object > Relations > Make Local).":
        "{name} ist aus einer anderen Datei verknüpft und kann kein Starrkörper sein: erst lokal machen (Objekt > Beziehungen > Lokal machen).",
    "The name of {name} is too long for the names of its hulls: shorten it.":
        "Der Name von {name} ist zu lang, um seine Hüllen danach zu benennen: bitte kürzen.",
    "Another object has the name {name}, which a hull needs: rename that object.":
        "Ein anderes Objekt heißt {name}, wie eine Hülle heißen würde: bitte umbenennen.",
    "{count} convex hulls around {name} with {times:.2f} times its volume.":
        "{count} konvexe Hüllen um {name}, zusammen vom {times:.2f}-Fachen seines Volumens.",
    "Count":
        "Anzahl",
    "Primitives":
        "Grundkörper",
    "Replace a hull by a box, sphere, capsule or cylinder within this distance from it, relative as for Error; 0: hulls only":
        "Quader, Kugel, Kapsel oder Zylinder nehmen, wo nichts davon weiter als dies von der Hülle weg ist, ein Anteil wie beim Fehler; 0: nur Hüllen",
    "The worker process {how} before it was done.":
        "Der Arbeitsprozess {how}, bevor er fertig war.",
    "Merging vertices by distance, or a voxel remesh, often helps.":
        "Oft hilft es, Vertices nach Abstand zusammenzuführen, oder ein Voxel-Remesh.",
    "The worker process gave a damaged answer.":
        "Die Antwort des Arbeitsprozesses war beschädigt.",
    "The worker process gave a damaged answer: {reason}":
        "Die Antwort des Arbeitsprozesses war beschädigt: {reason}",
    "The worker process returned the parts of another mesh.":
        "Der Arbeitsprozess gab die Antwort zu einem anderen Mesh.",
    "There is no Python to run the worker process: {reason}.":
        "Es gibt kein Python für den Arbeitsprozess: {reason}.",
    "The worker process could not be started: {reason}.":
        "Der Arbeitsprozess konnte nicht gestartet werden: {reason}.",
    "The worker process did not begin in {seconds} seconds.":
        "Der Arbeitsprozess hat in {seconds} Sekunden nicht begonnen.",
    "The worker process {how} before it began.":
        "Der Arbeitsprozess {how}, bevor er begann.",
    "If this happens again, choose a Python 3 to run it: Python in the add-on's preferences, or the argument python.":
        "Wenn es so bleibt, angeben, welches Python 3 ihn ausführen soll: Python in den Einstellungen des Add-ons oder das Argument python.",
    "was killed (SIGKILL, possibly because memory ran out)":
        "wurde abgebrochen (SIGKILL, vielleicht aus Mangel an Speicher)",
    "crashed ({reason})":
        "ist abgestürzt ({reason})",
    "was interrupted (Ctrl-C)":
        "wurde von außen beendet (Strg C)",
    "ended without an answer (exit code {code})":
        "endete ohne Antwort (Exit-Code {code})",
    "did not answer in {seconds} seconds":
        "antwortete in {seconds} Sekunden nicht",
    "can't be started ({reason})":
        "kann nicht gestartet werden ({reason})",
    "there is none":
        "es gibt keines",
    "Remove the parts of the active mesh, also those saved with the file. The mesh stays as it is":
        "Die Teile des aktiven Meshs löschen, auch die mit der Datei gespeicherten. Das Mesh bleibt, wie es ist",
    "{name} no longer has a part similar to {part}. Pick the part again, forget the name {part}, and remember the part under this name.":
        "{name} hat kein Teil mehr, das {part} ähnelt. Das Teil neu wählen, den Namen {part} vergessen und das Teil unter diesem Namen merken.",
    "{name} has no remembered part {part}. Pick the part, and name it with Remember Part.":
        "{name} hat kein gemerktes Teil {part}. Das Teil wählen und mit „Teil merken“ benennen.",
    "{name} has a Multiresolution modifier, whose details would be lost. Apply the modifier first.":
        "{name} hat einen Multires-Modifikator, dessen Details verloren gingen. Erst den Modifikator anwenden.",
    "{name} has a Multiresolution modifier: the new objects have only its coarsest level. To keep the details, apply the modifier first.":
        "{name} hat einen Multires-Modifikator: Die neuen Objekte haben nur dessen gröbste Stufe. Um die Details zu behalten, erst den Modifikator anwenden.",
    "Duplicate Selection":
        "Auswahl duplizieren",
    "The mesh is too broken for this. Remesh it and try again.":
        "Das Mesh ist dafür zu beschädigt. Remesh anwenden und erneut versuchen.",
    "So many triangles pass through each other that the inside can't be found. Remesh the model, or unite its parts with a Boolean.":
        "So viele Dreiecke durchdringen einander, dass sich das Innere nicht bestimmen lässt. Remesh anwenden oder die Teile mit einem Boolean vereinen.",
    "There is not enough memory. Close other programs, or decimate the mesh.":
        "Der Arbeitsspeicher reicht nicht. Andere Programme schließen oder das Mesh dezimieren.",
    "No vertex is free to deform: the handle must be smaller than the part, and connected with it.":
        "Kein Vertex kann sich verformen: Der Griff muss kleiner als das Teil und mit ihm verbunden sein.",
    "The shape keys of {names} are lost; the parts keep their current shape. The shape keys of {target} move only its own surface.":
        "Die Formschlüssel von {names} gehen verloren; die Teile behalten ihre jetzige Form. Die Formschlüssel von {target} bewegen nur seine eigene Oberfläche.",
    "The model has {count:,} duplicate faces. The objects contain each of them once.":
        "Das Modell hat {count:,} doppelte Flächen. Die Objekte enthalten jede davon einmal.",
    "The volumes of the objects add up to {total:.4g}, but the model's volume is {whole:.4g}, because its surface is broken. Repair the mesh, or turn off Closed.":
        "Die Volumen der Objekte ergeben zusammen {total:.4g}, das Modell hat aber {whole:.4g}, weil seine Oberfläche beschädigt ist. Das Mesh reparieren oder „Geschlossen“ ausschalten.",
    "Only the mesh of {name} itself is printed, without the effect of its modifiers. To print it, apply them first.":
        "Nur das Mesh von {name} selbst wird gedruckt, ohne die Wirkung seiner Modifikatoren. Um sie mitzudrucken, die Modifikatoren erst anwenden.",
    "How the part follows the handle":
        "Wie das Teil dem Griff folgt",
    "How the parts change the current selection":
        "Wie die Teile die jetzige Auswahl ändern",
    "The part is the whole model, which has no other side. Pick a smaller one.":
        "Das Teil ist das ganze Modell, das keine andere Seite hat. Ein kleineres wählen.",
    "The part is the whole model: nothing would be left without it. Pick a smaller one.":
        "Das Teil ist das ganze Modell: Ohne es bliebe nichts. Ein kleineres wählen.",
    "The scene is linked from another file, so no object can be added to it.":
        "Die Szene ist aus einer anderen Datei verknüpft, daher kann ihr kein Objekt hinzugefügt werden.",
    "The modifier {modifier} is bound to the vertices of {name}, which change: bind it again afterwards.":
        "Der Modifikator {modifier} ist an die Vertices von {name} gebunden, die sich ändern: danach neu binden.",
    "The selection must be exactly one whole part. Pick the part again with Select Part by Wheel, and confirm it.":
        "Die Auswahl muss genau ein ganzes Teil sein. Das Teil mit „Teil per Mausrad auswählen“ neu wählen und bestätigen.",
    "New Part":
        "Neues Teil",
}
