# SPDX-License-Identifier: GPL-3.0-or-later
"""Spanish."""

WORDS = {
    "Turn":
        "Giro",
    "About the border's normal":
        "Alrededor de la normal del borde",
    "Depth":
        "Profundidad",
    "How deep the part sinks in, in radii of its border":
        "Cuánto se hunde, por el radio de su borde",
    "size {size:.2f}, turn {turn:.0f}°, depth {depth:.2f}":
        "tamaño {size:.2f}, giro {turn:.0f}°, profundidad {depth:.2f}",
    "Place Part":
        "Colocar parte",
    "Place the active part on a surface: it follows the mouse with its border on the surface":
        "Coloca la parte activa sobre una superficie: sigue al ratón, con su borde sobre la superficie y orientada hacia ella",
    "{operator} stopped: the part is no longer the active object.":
        "{operator} se detuvo: la parte ya no es el objeto activo.",
    "Onto":
        "Sobre",
    "The object that the part is placed on":
        "El objeto sobre el que se coloca la parte",
    "Location":
        "Posición",
    "Location of the part's border":
        "Adónde va su borde",
    "Normal":
        "Normal",
    "Normal of the surface at the location":
        "De la superficie en ese punto",
    "Size":
        "Tamaño",
    "Factor of the part's size":
        "Por el tamaño que tenía",
    "Fit Border":
        "Encajar borde",
    "Fit the part to the target's nearest border, where a part was removed":
        "En el borde más cercano del objetivo, donde se quitó una parte, y con su tamaño",
    "Mirror Copy":
        "Copia simétrica",
    "Add the mirror image across the target's own X axis":
        "Agrega la imagen simétrica respecto al eje X propio del objetivo",
    "In Object Mode, make the part that you want to place the active object.":
        "En modo Objeto, hacer que la parte a colocar sea el objeto activo.",
    "Choose the mesh object to place the part on.":
        "Se debe indicar sobre qué objeto de malla se coloca la parte.",
    "Move the mouse over a surface":
        "Mover el ratón sobre una superficie",
    "There is no surface under the mouse yet":
        "Aún no hay ninguna superficie bajo el ratón",
    "Onto {name}":
        "Sobre {name}",
    "fitted":
        "encajada",
    "with mirror copy":
        "con copia simétrica",
    "{name} has no border to fit: no part was removed from it.":
        "{name} no tiene ningún borde donde encajar: no se le quitó ninguna parte.",
    "Swap with Compatible Part":
        "Cambiar por parte compatible",
    "Exchange the picked part for one of another object that fits its border; the wheel goes through the candidates":
        "Cambia la parte elegida por una de otro objeto que encaje en su borde; la rueda recorre las que hay",
    "{operator} stopped: the object is no longer the active one.":
        "{operator} se detuvo: el objeto ya no es el activo.",
    "From":
        "Desde",
    "The object that the new part comes from; none: the other selected objects, or else all others":
        "El objeto del que viene la nueva parte; ninguno: los seleccionados o, si no, todos los demás",
    "Part":
        "Parte",
    "Number of the new part in its object; -1: the most compatible part":
        "El número de la nueva parte en ese objeto; -1: la más compatible",
    "Factor of the size at which the borders fit":
        "Por el tamaño con que encajan los bordes",
    "Mirror":
        "Simetría",
    "Use the part's mirror image":
        "Toma la imagen simétrica de la parte",
    "Blend":
        "Fundir",
    "Width of a smooth transition on either side of the seam, in radii of the seam":
        "Anchura de una transición suave a cada lado de la costura, por su radio",
    "Find Parts":
        "Encontrar partes",
    "Find the parts of the new mesh afterwards, in the background":
        "Encuentra enseguida las partes de la nueva malla, en un proceso aparte",
    "There is no mesh object {name}.":
        "No hay ningún objeto de malla {name}.",
    "{name}, part {number} of {count}, {likeness:.0%} similar":
        "{name}, parte {number} de {count}, parecida en un {likeness:.0%}",
    "mirrored":
        "simétrica",
    "Leave Edit Mode":
        "Salir del modo Edición",
    "The part is the whole model: nothing would be left to put another part on. Pick a smaller one.":
        "La parte es todo el modelo: no quedaría nada donde poner otra. Elegir una más pequeña.",
    "The part has no border with the rest of the model, so no other part can be fitted to it. Pick a part that is connected to the rest.":
        "La parte no tiene borde con el resto del modelo, así que no hay nada donde encajar otra. Elegir una que salga del modelo, no una pieza suelta.",
    "No other object has parts. Find the parts of the object that the new part comes from, and select this object, too; or paste a part that was copied as a solid.":
        "Ningún otro objeto tiene partes. Encontrar las partes del objeto del que viene la nueva y seleccionarlo también; o pegar una parte copiada como sólido.",
    "No part there has a border that fits the picked part's.":
        "Ninguna parte de allí tiene un borde que encaje en el de esta.",
    "{name} has no part {number}.":
        "{name} no tiene ninguna parte {number}.",
    "That part of {name} has no border that fits the picked part's.":
        "Esa parte de {name} no tiene un borde que encaje en el de esta.",
    "{name} has changed and has other parts now. Start again.":
        "{name} fue modificado y ahora tiene otras partes. Empezar de nuevo.",
    "it has no faces":
        "no tiene caras",
    "{count} edges don't have exactly two faces":
        "{count} bordes no tienen exactamente dos caras",
    "{count} edges have faces of opposite orientation":
        "en {count} bordes las caras están orientadas una contra otra",
    "{count} vertices are loose or connect parts that only touch there":
        "{count} vértices están sueltos o unen partes que solo se tocan ahí",
    "{name} is not a solid: {reason}. Repair it, or copy the part again.":
        "{name} no es un sólido: {reason}. Repararlo o copiar su parte de nuevo.",
    "{name} is not a solid: it is inside out. Turn its faces outside (Recalculate Outside).":
        "{name} no es un sólido: está del revés. Orientar sus caras hacia afuera (Recalcular hacia afuera).",
    "by {solver} within: {reason}":
        "con {solver}, por dentro: {reason}",
    "by {solver}: {reason}":
        "con {solver}: {reason}",
    "{one} and {other} can't be united ({reasons}). Move one of them a little: overlapping coplanar faces are the usual cause.":
        "{one} y {other} no se pueden unir ({reasons}). Mover un poco uno de ellos: la causa habitual son caras situadas una sobre otra.",
    "its volume would be {share:.0%} of the sum of both volumes":
        "su volumen sería el {share:.0%} del de ambos",
    "one of them is missing":
        "uno de ellos quedó fuera",
    "In Object Mode, select the parts, and then the mesh object to unite them with.":
        "En modo Objeto, seleccionar las partes y después el objeto de malla del que deben formar parte.",
    "Unite Solids":
        "Unir sólidos",
    "Unite the other selected solids with the active one into a single closed mesh":
        "Une los demás sólidos seleccionados con el activo en una única malla cerrada",
    "Width of a smooth transition on either side of each seam, in radii of the seam; 0: the seam stays a crease":
        "Anchura de una transición suave a cada lado de cada costura, por el radio de esta; 0: la costura queda marcada",
    "Find the parts of the united mesh afterwards, in the background":
        "Encuentra enseguida las partes de la malla unida, en un proceso aparte",
    "Keep Parts":
        "Conservar partes",
    "Keep the other objects":
        "Deja los demás objetos como están",
    "{name} is now one closed mesh with {count:,} faces (solver {solver}).":
        "{name} es ahora una malla cerrada de {count:,} caras (algoritmo {solver}).",
    "The vertex group {name} is locked. Unlock it, or give it another name.":
        "El grupo de vértices {name} está bloqueado. Desbloquearlo o darle otro nombre.",
    "Face Sets":
        "Conjuntos de caras",
    "One for each part; they replace the existing ones":
        "Uno por cada parte, en lugar de todos los existentes",
    "Vertex Groups":
        "Grupos de vértices",
    "For an armature: smooth across the borders, with a sum of 1":
        "Para un esqueleto: disminuyen suavemente a través de los bordes y suman 1",
    "Colored Materials":
        "Materiales de colores",
    "A material with a color of its own for each part":
        "Un material de color propio para cada parte",
    "Material Slots":
        "Ranuras de material",
    "The model's own materials, with a slot for each part":
        "Los materiales propios del modelo, con una ranura por cada parte",
    "Seams":
        "Costuras",
    "For unwrapping: along the borders, in creases, and where a part would not lie flat":
        "Para desplegar: a lo largo de los bordes, en los pliegues y donde una parte no quedaría plana",
    "Objects":
        "Objetos",
    "Each part becomes an object, parented to its neighbor":
        "Cada parte, un objeto que cuelga del siguiente",
    "Bones":
        "Huesos",
    "An armature with a bone for each part, and its vertex groups, ready to pose":
        "Un esqueleto con un hueso por cada parte y sus grupos de vértices, listo para posar",
    "For Printing":
        "Para imprimir",
    "Closed objects with flat cuts, pegs and sockets, checked. Needs manifold3d":
        "Objetos cerrados con cortes planos, espigas y encajes, comprobados. Requiere manifold3d",
    "Parts to...":
        "Partes a...",
    "Divide the whole model into parts: the wheel changes the number, a click and the wheel one part, a drag merges":
        "Divide todo el modelo en partes: la rueda cambia cuántas, un clic y la rueda una sola, arrastrar las fusiona",
    "Create":
        "Crear",
    "What to create from the parts; none: only save them in the mesh":
        "En qué se convierten las partes; nada: solo se conservan en la malla",
    "Parts":
        "Partes",
    "Number of parts; 0: the parts saved in the mesh, or the automatic segmentation":
        "Cuántas; 0: las que se conservan en la malla o como las vería la mayoría de la gente",
    "Closed":
        "Cerrados",
    "Close the objects where they were cut, so that they are solids that add up to the whole":
        "Cierra los objetos donde se cortaron: sólidos que forman el conjunto",
    "Smooth Caps":
        "Tapas suaves",
    "Close the objects with a smooth surface instead of flat facets":
        "Los cierra con una superficie suave, en lugar de las facetas planas del interior que los separan del resto",
    "Cap Material":
        "Material de tapas",
    "Give the caps a material of their own":
        "Da a las tapas un material propio",
    "Origins at Borders":
        "Orígenes en los bordes",
    "Place the origin of each object at the center of its border":
        "Cada objeto gira alrededor del centro de su borde",
    "Explode":
        "Explotar",
    "Distance by which the objects move apart, times the distance of their centers. You can change it later in a custom property of the largest object":
        "Cuánto se separan, según la distancia entre sus centros. El más grande lo tiene también como propiedad personalizada, que se puede cambiar después",
    "Shell":
        "Cáscara",
    "Thickness of the walls, by a modifier; 0: solid":
        "El grosor de sus paredes, mediante un modificador; 0: macizos",
    "Unwrap":
        "Desplegar",
    "Unwrap the mesh along the seams, into a new UV map if there are others":
        "Despliega la malla por las costuras, en un nuevo mapa UV si tiene otros",
    "Pegs":
        "Espigas",
    "Add a peg and a socket across each cut, where there is room":
        "Una espiga y un encaje en cada corte, donde hay espacio",
    "Clearance (mm)":
        "Holgura (mm)",
    "The gap around each peg, on all sides":
        "El hueco alrededor de cada espiga, por todos los lados",
    "Wall (mm)":
        "Pared (mm)",
    "Minimum thickness of the walls around a socket; a message reports thinner walls":
        "Lo que queda alrededor de un encaje; se avisa de las paredes más finas",
    "Bed (mm)":
        "Base (mm)",
    "Size of the printer's bed: larger parts are split further; 0: no limit":
        "La de la impresora: las partes más grandes se dividen más; 0: suficientemente grande",
    "Hide Original":
        "Ocultar original",
    "Hide the object that was divided":
        "Oculta el objeto que se dividió",
    "This is for an active mesh object, in Object, Edit or Sculpt Mode.":
        "Esto es para un objeto de malla activo, en modo Objeto, Edición o Escultura.",
    "Dynamic topology changes the faces all the time: turn it off first.":
        "La topología dinámica cambia las caras todo el tiempo: desactivarla antes.",
    "These are not parts of {name}: {reason}":
        "Estas no son partes de {name}: {reason}",
    "{name} now has {count} parts: {results}.":
        "{name} está ahora en {count} partes: {results}.",
    "{count} parts: {results}":
        "{count} partes: {results}",
    "{count} parts, one of {faces:,} faces: {results}":
        "{count} partes, una de {faces:,} caras: {results}",
    "Saved in the Mesh":
        "Conservadas en la malla",
    "Printing needs the Python package manifold3d, which Blender doesn't have. To install it, run: {python} -m pip install manifold3d.":
        "Para imprimir se necesita el paquete de Python manifold3d, que Blender no trae. Para instalarlo, ejecutar: {python} -m pip install manifold3d.",
    "The scale of {name} is not uniform: apply its scale first.":
        "{name} tiene escalas distintas en sus ejes: aplicar antes la escala.",
    "{name} has {count} UV maps, the most that Blender allows: remove one.":
        "{name} tiene {count} mapas UV, no caben más: eliminar uno.",
    "Handle of one vertex":
        "Asa de un vértice",
    "Handle of {count:,} vertices":
        "Asa de {count:,} vértices",
    "The whole part":
        "Toda la parte",
    "Joint of {reach:.1f} radii":
        "Articulación de {reach:.1f} radios",
    "The handle covers the whole part, so nothing is left to follow it: make the handle smaller.":
        "El asa es toda la parte, así que no queda nada que la siga: reducir el asa.",
    "One handle covers another: make it smaller or move it.":
        "Un asa cubre a otra: reducirla o ponerla en otro lugar.",
    "No visible part of this limb is beyond its joint: make the joint smaller.":
        "Ninguna parte de esta extremidad queda visible más allá de su articulación: reducir la articulación.",
    "Move":
        "Mover",
    "Rotate":
        "Rotar",
    "Scale":
        "Escalar",
    "{movement} along local {axes}":
        "{movement} en {axes} local",
    "{movement} along global {axes}":
        "{movement} en {axes} global",
    "{movement} in local {axes}":
        "{movement} en el plano {axes} local",
    "{movement} in global {axes}":
        "{movement} en el plano {axes} global",
    "Vertex":
        "Vértice",
    "Radius":
        "Radio",
    "Matrix":
        "Matriz",
    "Deform Part":
        "Deformar parte",
    "Drag a handle of the last picked part: the part follows like a soft body, and the rest of the mesh stays in place":
        "Arrastra un asa de la última parte elegida: la parte la sigue como un cuerpo blando y todo lo demás se queda",
    "Number of the part; -1: the last pick":
        "El número de la parte; -1: la última elegida",
    "Method":
        "Método",
    "As Rigid as Possible":
        "Lo más rígida posible",
    "The part follows the handle and keeps its details":
        "La parte sigue al asa y conserva sus detalles",
    "Proportional":
        "Proporcional",
    "The part moves as a whole, less toward its border":
        "La parte se mueve entera, cada vez menos hacia su borde",
    "At the Joint":
        "En la articulación",
    "The part keeps its shape and turns at its border; the mesh near the border bends":
        "La parte conserva su forma y gira alrededor de su borde; lo cercano a este, a ambos lados, se dobla",
    "Rings":
        "Anillos",
    "Rings of faces around the part that deform with it, for a softer transition":
        "Cuántos anillos de caras alrededor de la parte se deforman con ella, para una unión más suave",
    "Joint":
        "Articulación",
    "Distance from the border within which the mesh bends, in radii of the border":
        "Hasta qué distancia del borde de la parte se dobla, en radios del borde",
    "Snap Border":
        "Ajustar borde",
    "Deform the part up to the creases near its border instead of its own border; on for picks with a snapped border":
        "Deforma la parte hasta los pliegues cercanos a su borde, no hasta su propio borde; como una parte elegida así",
    "Deform parts in Edit Mode of a mesh.":
        "Las partes se deforman en el modo Edición de una malla.",
    "There is no handle: drag one in the 3D view.":
        "No hay ningún asa: arrastrar una en la vista 3D.",
    "The mesh doesn't have the vertex of a handle.":
        "Un asa es un vértice que la malla no tiene.",
    "{state}: settling":
        "{state}: asentándose",
    "{state}: getting ready":
        "{state}: preparándose",
    "Move Part Proportionally":
        "Mover parte proporcionalmente",
    "Move the last picked part; its surroundings follow, depending on its size. R rotates and S scales it":
        "Mueve la última parte elegida; su entorno la sigue, según su tamaño. R la rota y S la escala",
    "The part has no visible vertex inside its border: pick a larger one.":
        "La parte no tiene ningún vértice visible dentro de su borde: elegir una más grande.",
    "The part is the whole mesh or a loose piece, without a border that would stay fixed: pick a smaller one, or move it with Blender's own tools.":
        "La parte es toda la malla, o una pieza suelta de ella, sin un borde que la sujete: elegir una más pequeña o moverla tal cual.",
    "The faces of the part have no area: there is nothing to deform.":
        "Las caras de la parte no tienen área: no hay nada que deformar.",
    "This point is not on the part.":
        "Ese no es un punto de la parte.",
    "The mesh of {name} is linked from another file: make it local first (Object > Relations > Make Local).":
        "La malla de {name} está vinculada desde otro archivo: hacerla local antes (Objeto > Relaciones > Hacer local).",
    "The mesh of {name} is a library override, which Blender does not edit: make it local first (Object > Relations > Make Local).":
        "La malla de {name} es una redefinición de biblioteca, que Blender no edita: hacerla local antes (Objeto > Relaciones > Hacer local).",
    "This is for an active mesh object, in Edit Mode or Object Mode.":
        "Esto es para un objeto de malla activo, en modo Edición o modo Objeto.",
    "The build was canceled.":
        "Se canceló la búsqueda de partes.",
    "The mesh {name} was deleted, so its parts were discarded.":
        "La malla {name} ya no está, así que sus partes se descartaron.",
    "{name} was edited while its parts were being found, so they were discarded. Find them again after editing.":
        "{name} se editó mientras se buscaban sus partes, así que se descartaron. Buscarlas de nuevo cuando la malla esté como se desea.",
    "The selection is not a part. Pick one with Select Part by Wheel, and confirm it.":
        "Lo seleccionado no es una parte. Elegir una con «Seleccionar parte con la rueda» y confirmarla.",
    "No part is picked. Pick one with Select Part by Wheel, and confirm it.":
        "No hay ninguna parte elegida. Elegir una con «Seleccionar parte con la rueda» y confirmarla.",
    "There is no part {number}: there are {count}.":
        "No hay ninguna parte {number}: hay {count}.",
    "{name} has no parts for its current mesh. Find them first.":
        "{name} no tiene partes para su malla tal como está. Encontrarlas antes.",
    "The parts saved with {name} come from a newer version of Partwheel, so they are found again. Update Partwheel to use the saved parts.":
        "Las partes guardadas con {name} son de un Partwheel más nuevo que este, así que se buscan de nuevo. Actualizar Partwheel para tener las del archivo.",
    "Partwheel finds the parts of {name} after those of {other}":
        "Partwheel buscará las partes de {name} después de las de {other}",
    "Partwheel finds the parts of {name}: {fraction:.0%}":
        "Partwheel busca las partes de {name}: {fraction:.0%}",
    "Esc: Cancel":
        "Esc: Cancelar",
    "Canceled: no parts were found.":
        "Cancelado: no se encontró ninguna parte.",
    "To do so, use the panel Partwheel in the sidebar.":
        "El panel Partwheel de la barra lateral lo hace.",
    "No parts for {name}: {reason}":
        "No hay partes para {name}: {reason}",
    "A method that was tried first failed: {reason}":
        "Falló una vía que se probó primero: {reason}",
    "{name}, {count:,} faces: its parts were found in {seconds:.1f} s.":
        "{name}, {count:,} caras: se encontraron sus partes en {seconds:.1f} s.",
    "Quality":
        "Calidad",
    "0 is fastest and right for nearly all meshes. From 1.1 on, the inside is divided more evenly (1.4 is usual, smaller is slower)":
        "0 es lo más rápido y adecuado para casi todo; a partir de 1,1 el interior se divide de forma más regular (1,4 es lo habitual, menos es más lento)",
    "Exactly":
        "Exactamente",
    "Find the parts of a mesh with more than 200,000 triangles at full resolution, not on a coarser copy. Takes about ten times the time and memory. The add-on's preferences can set this for all meshes":
        "Encuentra las partes de una malla de más de 200.000 triángulos en todos ellos, no en una copia más basta: unas diez veces más tiempo y memoria. En las preferencias del complemento se puede fijar para todas",
    "Find Parts of Mesh":
        "Encontrar partes de la malla",
    "Find the parts of the active mesh, and of other selected ones that have none, at all sizes for the wheel":
        "Encuentra las partes de la malla activa, y de otras seleccionadas que no tengan, en todos los tamaños para la rueda",
    "Find the parts of a mesh that another operator has just created; that operator stays the last operation, with its panel":
        "Lo mismo para un operador que hizo la malla y que sigue siendo la última operación, con su panel",
    "Clear Parts":
        "Borrar partes",
    "The active object has no parts.":
        "El objeto activo no tiene partes.",
    "Part under the Mouse":
        "Parte bajo el ratón",
    "Face Set":
        "Conjunto de caras",
    "Mask":
        "Máscara",
    "Vertex Group":
        "Grupo de vértices",
    "Paint Mask":
        "Máscara de pintura",
    "Part by Wheel":
        "Parte con la rueda",
    "Pick a part with a click and the mouse wheel, and make it a face set, a mask or a vertex group":
        "Elige una parte con un clic y la rueda del ratón y la convierte en conjunto de caras, máscara o grupo de vértices",
    "What the part becomes":
        "En qué se convierte la parte",
    "A new face set":
        "Un nuevo conjunto de caras",
    "Masked against sculpting":
        "Protegida al esculpir",
    "Weight 1 in a new vertex group named after the part; Extend adds it to the active group, Deselect removes it from there":
        "Influencia 1 en un nuevo grupo de vértices con el nombre de la parte; con Extender, en el activo; con Deseleccionar, ninguna allí",
    "The only faces that can be painted on":
        "Las únicas caras sobre las que se puede pintar",
    "This is for Sculpt Mode and the paint modes of a mesh.":
        "Esto es para el modo Escultura y los modos de pintura de una malla.",
    "In this mode, parts can't become this: {results}.":
        "En este modo las partes no pueden convertirse en esto: {results}.",
    "Face":
        "Cara",
    "The face that was clicked":
        "La cara en que se hizo clic",
    "Level":
        "Nivel",
    "Notches of the wheel from the part that the click selects; up is positive":
        "Pasos de la rueda desde la parte que toma el clic por sí solo: hacia arriba es positivo",
    "Extend":
        "Extender",
    "Add the part to the selection instead of replacing it":
        "Agrega la parte a lo seleccionado, en lugar de reemplazarlo",
    "Deselect":
        "Deseleccionar",
    "Remove the part from the selection":
        "Quita la parte de lo seleccionado",
    "Move the border of the part into nearby creases":
        "Lleva el borde de la parte a los pliegues cercanos",
    "Face {number} can't be picked: {reason}":
        "La cara {number} no se puede elegir: {reason}",
    "This 3D view does not show the mesh that is being edited.":
        "Esta vista 3D no muestra la malla que se está editando.",
    "Click a face of the mesh":
        "Hacer clic en una cara de la malla",
    "The face there was generated by the modifiers of {name} and belongs to no face of its mesh.":
        "Lo que se ve ahí lo hicieron los modificadores de {name} y no pertenece a ninguna cara de su malla.",
    "The parts are found. Start {operator} again to pick them.":
        "Las partes se encontraron. Iniciar {operator} de nuevo para elegirlas.",
    "Partwheel stopped: the parts were found again. Pick one of them.":
        "Partwheel se detuvo: las partes se encontraron de nuevo. Elegir una de ellas.",
    "There is no face there":
        "Ahí no hay ninguna cara",
    "Part {number} of {count}, {faces:,} faces, {share} of the area":
        "Parte {number} de {count}, {faces:,} caras, {share} del área",
    "border in creases":
        "borde en pliegues",
    "Select Part by Wheel":
        "Seleccionar parte con la rueda",
    "Pick a part of the mesh with a click, then make it larger or smaller with the mouse wheel":
        "Elige una parte de la malla con un clic y luego la agranda o la reduce con la rueda del ratón",
    "Select parts in Edit Mode of a mesh.":
        "Las partes se seleccionan en el modo Edición de una malla.",
    "Pick a part of the mesh under the mouse in Object Mode, then enter Edit Mode with the part selected":
        "Elige una parte de la malla bajo el ratón, que entretanto queda como está, y entra con ella en modo Edición",
    "This is for Object Mode.":
        "Esto es para el modo Objeto.",
    "There is no mesh under the mouse.":
        "No hay ninguna malla bajo el ratón.",
    "{name} is an instance, and this 3D view does not show its original: edit it there.":
        "{name} es una instancia y esta vista 3D no muestra su original: editarlo allí.",
    "Toggle Edit Mode":
        "Alternar modo Edición",
    "Select Part":
        "Seleccionar parte",
    "Select a meaningful part of the mesh.\nClick a part, then turn the wheel for the next larger or smaller one. Shift adds, Ctrl removes":
        "Selecciona una parte con sentido de la malla.\nHacer clic en una parte y girar la rueda para la siguiente más grande o más pequeña. Mayús agrega, Ctrl quita",
    "Parts are found at the first click":
        "Las partes se buscan con el primer clic",
    "Pick a meaningful part of a mesh.\nClick a part, then turn the wheel for the next larger or smaller one. Shift adds, Ctrl removes":
        "Tomar una parte con sentido de una malla.\nHacer clic en una parte y girar la rueda para la siguiente más grande o más pequeña. Mayús agrega, Ctrl quita",
    "Mask a meaningful part of the mesh, or make it a face set.\nClick a part, then turn the wheel for the next larger or smaller one. Shift adds, Ctrl removes":
        "Enmascarar una parte con sentido de la malla, o convertirla en un conjunto de caras.\nHacer clic en una parte y girar la rueda para la siguiente más grande o más pequeña. Mayús agrega, Ctrl quita",
    "Make a meaningful part of the mesh a vertex group.\nClick a part, then turn the wheel for the next larger or smaller one. Shift adds, Ctrl removes":
        "Convertir una parte con sentido de la malla en un grupo de vértices.\nHacer clic en una parte y girar la rueda para la siguiente más grande o más pequeña. Mayús agrega, Ctrl quita",
    "Paint only on a meaningful part of the mesh.\nClick a part, then turn the wheel for the next larger or smaller one. Shift adds, Ctrl removes":
        "Pintar solo en una parte con sentido de la malla.\nHacer clic en una parte y girar la rueda para la siguiente más grande o más pequeña. Mayús agrega, Ctrl quita",
    "Select all parts that a box touches, at the level of the last pick.\nShift adds, Ctrl removes. A click picks a part as with Select Part":
        "Seleccionar todas las partes que toca un marco, con tantos pasos como la última parte tomada.\nMayús agrega, Ctrl quita. Un clic toma una parte como con Seleccionar parte",
    "Select all parts that a lasso touches, at the level of the last pick.\nShift adds, Ctrl removes. A click picks a part as with Select Part":
        "Seleccionar todas las partes que toca un lazo, con tantos pasos como la última parte tomada.\nMayús agrega, Ctrl quita. Un clic toma una parte como con Seleccionar parte",
    "Select all parts (segments, regions) that a box touches, at the level of the last pick":
        "Seleccionar todas las partes (segmentos, regiones) que toca un marco, con tantos pasos como la última parte tomada",
    "Select all parts (segments, regions) that a lasso touches, at the level of the last pick":
        "Seleccionar todas las partes (segmentos, regiones) que toca un lazo, con tantos pasos como la última parte tomada",
    "Select Parts by Box":
        "Seleccionar partes con marco",
    "Select Parts by Lasso":
        "Seleccionar partes con lazo",
    "Select the whole parts that a gesture touched":
        "Convertir lo que seleccionó un gesto en las partes enteras que tocó",
    "Mode":
        "Modo",
    "Set":
        "Definir",
    "Select these parts and nothing else":
        "Seleccionar estas partes y nada más",
    "Add these parts to the selection":
        "Agregarlas a lo seleccionado",
    "Subtract":
        "Sustraer",
    "Remove these parts from the selection":
        "Quitarlas de lo seleccionado",
    "Parts: Store Selection":
        "Partes: lo seleccionado",
    "Whole Parts":
        "Partes enteras",
    "Store the current selection":
        "Recordar lo seleccionado",
    "Pick Part by Wheel":
        "Tomar parte con la rueda",
    "Pick a part of the mesh under the mouse to copy, swap or divide it; it is also selected in Edit Mode":
        "Tomar una parte de la malla bajo el cursor, para copiarla, intercambiarla o dividirla; en el modo Edición está seleccionada",
    "A mask in Sculpt Mode, a vertex group in Weight Paint, else a paint mask":
        "Una máscara en modo Escultura, un grupo de vértices al pintar influencias, si no una máscara de pintura",
    "When the wheel resizes the part, after a click with the tool":
        "Cuándo la rueda agranda y reduce la parte, después de un clic con la herramienta",
    "At the Click":
        "En el clic",
    "While the mouse stays at the click; elsewhere the wheel zooms as usual":
        "Mientras el cursor está donde hizo clic; en cualquier otro lugar la rueda acerca y aleja como siempre",
    "Until Enter":
        "Hasta Intro",
    "Wherever the mouse is, until Enter or another key ends it":
        "Dondequiera que esté el cursor, hasta que Intro u otra tecla lo termine",
    "Buttons":
        "Botones",
    "Show two buttons beside the click, larger and smaller. With a pen they are always shown":
        "Mostrar dos botones junto al clic, más grande y más pequeña. Con un lápiz están siempre ahí",
    "Blender would not undo a mask of the multires modifier's levels. Make the part a face set instead: the tool's header and the menu Face Sets have it.":
        "Blender no desharía una máscara en los niveles del modificador multires. Convertir en cambio la parte en un conjunto de caras: está en el encabezado de la herramienta y en el menú de conjuntos de caras.",
    "Overlay":
        "Sobreimpresos",
    "The vertex group {name} is locked. Unlock it, or pick the part alone: it gets a group of its own.":
        "El grupo de vértices {name} está bloqueado. Desbloquearlo o elegir la parte sola: tendrá un grupo propio.",
    "{name} has no vertex group that the part could be removed from.":
        "{name} no tiene ningún grupo de vértices del que quitar la parte.",
    "The part was removed from the vertex group {name}.":
        "La parte se quitó del grupo de vértices {name}.",
    "The part was added to the vertex group {name}.":
        "La parte se agregó al grupo de vértices {name}.",
    "The part is the new vertex group {name}.":
        "La parte es el nuevo grupo de vértices {name}.",
    "Find on Import":
        "Encontrar al importar",
    "Find the parts of imported and appended meshes at once, while you keep working":
        "Las partes de lo importado o anexado se encuentran enseguida, mientras se sigue trabajando",
    "Find Parts of Imported Meshes":
        "Encontrar partes de mallas importadas",
    "Find the parts of newly imported meshes":
        "Encontrar las partes de las mallas seleccionadas que no las tienen, para la importación que las trajo",
    "Select meshes without parts, in Object Mode.":
        "Esto es para mallas seleccionadas sin partes, en Modo Objeto.",
    "Save Parts in .blend Files":
        "Guardar partes en archivos .blend",
    "Save the parts of meshes with the file, so that they need not be found again. The file grows by about 40 bytes per face":
        "Las partes encontradas vuelven a estar ahí al abrir el archivo, que crece unos 40 bytes por cara",
    "How the next builds merge small parts into larger ones":
        "Cómo se unen las partes pequeñas en otras más grandes de ahora en adelante",
    "As People See Them":
        "Como las ve la gente",
    "Learned from the parts that people chose on some hundred models: a click alone finds the intended part more often. Borders follow creases, and symmetric models get symmetric parts":
        "Según lo que la gente tomó por partes en varios cientos de modelos: un clic solo acierta más a menudo. Los bordes quedan en pliegues y los dos lados de un modelo simétrico son iguales",
    "Nearly Convex":
        "Casi convexas",
    "By convexity alone, the most regular and fastest method: a click selects the smallest part, and each notch of the wheel takes one step":
        "Solo por convexidad, lo más regular y rápido: un clic toma la pieza más pequeña que hay y cada paso de la rueda avanza uno",
    "Large Meshes at Full Resolution":
        "Mallas grandes exactamente",
    "Find the parts of meshes with more than 200,000 triangles at full resolution, not on a coarser copy. Takes about ten times the time and memory, for mostly the same parts":
        "Encuentra las partes de mallas de más de 200.000 triángulos en todos ellos, no en una copia más basta: unas diez veces más tiempo y memoria para partes casi siempre iguales",
    "Memory":
        "Memoria",
    "Share of the available memory that a build may use (enforced on Linux)":
        "Cuánta de la memoria disponible puede usar una búsqueda (se respeta en Linux)",
    "Time Limit":
        "Límite de tiempo",
    "Minutes of processor time after which a build is stopped. 0: two, plus two for each 60,000 triangles, far more than builds need":
        "Minutos de procesador tras los que se detiene una búsqueda; 0: dos, y dos más por cada 60.000 triángulos, mucho más de lo necesario",
    "Python":
        "Python",
    "The Python 3 program that runs builds in a separate process. Empty: the one in Blender, or else an installed one":
        "El programa con que se buscan las partes, un Python 3, en un proceso aparte; vacío: el que trae Blender o, si no, uno instalado",
    "Tint the picked part":
        "Tiñe la parte que se sostiene",
    "Next Part":
        "Parte siguiente",
    "Tint faintly what the next notch of the wheel adds":
        "Tiñe débilmente lo que agrega el siguiente paso de la rueda",
    "Convex Hull":
        "Envolvente convexa",
    "Show the convex hull of the picked part as glass":
        "Muestra como cristal la envolvente convexa de la parte que se sostiene",
    "All Parts":
        "Todas las partes",
    "Show all parts of the mesh at the size of the picked part, each in its own color":
        "Muestra las partes de toda la malla al tamaño de la que se sostiene, cada una de un color",
    "Pie Menu":
        "Menú circular",
    "The part has no mirror image in {name}: it crosses the symmetry plane, or the model is not symmetric.":
        "La parte no tiene imagen simétrica en {name}: atraviesa el plano de simetría o el modelo no es igual a ambos lados.",
    "Remember parts in Edit Mode of a mesh.":
        "Las partes se recuerdan en el modo Edición de una malla.",
    "Name of the remembered part":
        "El nombre con que se recuerda",
    "Remember Part":
        "Recordar parte",
    "Name the last picked part (segment, region), so that you can select it again from the panel's list":
        "Da a la última parte elegida (segmento, región) un nombre con el que la lista del panel la vuelve a seleccionar",
    "Name":
        "Nombre",
    "The part's name":
        "El nombre de la parte",
    "Part {number}":
        "Parte {number}",
    "Select Remembered Part":
        "Seleccionar parte recordada",
    "Select the remembered part. Shift adds it to the selection, Ctrl removes it":
        "Selecciona la parte recordada con este nombre. Mayús la agrega a lo seleccionado, Ctrl la quita",
    "Rename Part":
        "Renombrar parte",
    "Rename a remembered part":
        "Da otro nombre a una parte recordada",
    "New Name":
        "Nuevo nombre",
    "New name of the part":
        "El nombre de la parte de ahora en adelante",
    "Forget Part":
        "Olvidar parte",
    "Forget a remembered part; the mesh does not change":
        "Olvida el nombre de una parte; la malla queda como está",
    "Enter a name for the part.":
        "Una parte se recuerda por un nombre: no puede estar vacío.",
    "The name {name} is too long: use at most {count} letters, fewer in some scripts.":
        "{name} es demasiado largo para un nombre: puede tener {count} letras, menos en algunos alfabetos.",
    "There already is a remembered part {name}. Enter another name, or forget that part first.":
        "Ya hay una parte recordada como {name}. Dar otro nombre u olvidar antes esa.",
    "Add to the selection instead of replacing it":
        "Agrega a lo seleccionado, en lugar de reemplazarlo",
    "Select Similar Parts":
        "Seleccionar partes similares",
    "Select all parts (segments, regions) similar to the last pick, in all edited objects: fingers, legs, horns":
        "Selecciona todas las partes (segmentos, regiones) como la última elegida, en cada objeto que se edita: dedos, patas, cuernos",
    "Not searched, since they have no parts yet: {names}. Find their parts first.":
        "Sin buscar, pues allí aún no se conocen partes: {names}. Buscarlas primero.",
    "Threshold":
        "Umbral",
    "Minimum similarity of selected parts: 1 is the same shape and size; lower values select more parts":
        "Cuán parecidas son las partes que se seleccionan: 1 es la misma forma y tamaño, menos da más partes",
    "{count} parts, similarity at least {threshold:.2f}":
        "{count} partes, parecidas desde {threshold:.2f}",
    "Select Mirrored Part":
        "Seleccionar parte simétrica",
    "Select the part (segment, region) on the other side of the model, across its own plane of symmetry":
        "Selecciona la parte (segmento, región) del otro lado del modelo, respecto a su propio plano de simetría",
    "Plane":
        "Plano",
    "Number of the symmetry plane, the best one first":
        "De los planos en que el modelo es su propia imagen simétrica, primero el mejor",
    "Move the border of the part to the creases nearby, as far as the inside of the model allows":
        "Lleva el borde de la parte a los pliegues cercanos, hasta donde lo permite el interior",
    "Close the part with a smooth surface instead of flat facets":
        "Cierra la parte con una superficie suave, en lugar de las facetas planas del interior que la separan del resto",
    "Copy Part as Solid":
        "Copiar parte como sólido",
    "Copy the picked part as a solid: a new object, closed where it was cut; Ctrl C, Ctrl V take it to other files":
        "Copia la parte elegida como sólido: un nuevo objeto, cerrado donde se cortó; Ctrl C y Ctrl V lo llevan a otros archivos",
    "Remove Part":
        "Eliminar parte",
    "Remove the picked part from the mesh and close the hole":
        "Quita de la malla la parte elegida y cierra el hueco",
    "Split into Solids":
        "Dividir en sólidos",
    "Make each part of a cut a separate object: closed solids that fit each other exactly":
        "Hace de cada parte de un corte un objeto propio: sólidos cerrados que encajan exactamente",
    "By":
        "Según",
    "What decides where to cut":
        "Qué decide dónde cortar",
    "Number of parts; the last merges are undone":
        "En tantas partes, las que se unieron al final",
    "Number of parts; as nearly convex as possible in total":
        "En tantas partes, las que en total son más convexas",
    "Height":
        "Altura",
    "Into the largest parts of at most this concavity":
        "En las partes más grandes con esta concavidad como máximo",
    "How many parts":
        "Cuántas partes",
    "Largest concavity of a part: the volume between it and its convex hull":
        "Concavidad máxima de una parte: el volumen entre ella y su envolvente convexa",
    "Distance by which the parts move apart, times their distance from the center":
        "Cuánto se separan las partes, según su distancia al centro",
    "Hide the object that was split":
        "Oculta el objeto que se dividió",
    "This part has no faces of the mesh. Choose a larger one.":
        "Esta parte no tiene ninguna cara de la malla. Tomar una más grande.",
    "This part can't be closed: its border crosses itself. Choose a larger or smaller one.":
        "Esta parte no se puede cerrar: su borde se cruza consigo mismo. Tomar una más grande o más pequeña.",
    "Face Set from Part by Wheel":
        "Conjunto de caras de parte con la rueda",
    "Mask from Part by Wheel":
        "Máscara de parte con la rueda",
    "Vertex Group from Part by Wheel":
        "Grupo de vértices de parte con la rueda",
    "Paint Mask from Part by Wheel":
        "Máscara de pintura de parte con la rueda",
    "Parts as Solids":
        "Partes como sólidos",
    "Deform":
        "Deformar",
    "Drag a Handle":
        "Arrastrar un asa",
    "Turn at the Joint":
        "Girar en la articulación",
    "Within the part, proportionally:":
        "Dentro de la parte, proporcional:",
    "No parts yet":
        "Aún no hay partes",
    "Parts are stored in the file":
        "Las partes vinieron con el archivo",
    "Vertices have moved since: you can recompute the parts":
        "Se han movido vértices: las partes se pueden recalcular",
    "The mesh has changed: the next use finds its parts again":
        "La malla cambió: sus partes se buscarán de nuevo la próxima vez",
    "From the mesh as it is":
        "De la malla tal como está",
    "Repaired copy, {off} off":
        "Copia reparada, a {off}",
    "Points on it, {off} off":
        "Puntos sobre ella, a {off}",
    "Coarser copy, {off} off":
        "Copia más basta, a {off}",
    "Partwheel":
        "Partwheel",
    "Find at Full Resolution":
        "Encontrar exactamente",
    "Recompute":
        "Recalcular",
    "Part: {share} of the area":
        "Parte: {share} del área",
    "Parts of {count:,} faces":
        "Partes de {count:,} caras",
    "Part (Segment, Region, Island)":
        "Parte (segmento, región, isla)",
    "Path of the Part":
        "Recorrido de la parte",
    "Show the parts that the wheel goes through, from the smallest to the whole; click one to select it":
        "Muestra las partes que recorre la rueda, de la más pequeña al conjunto; un clic toma una",
    "Remembered Parts":
        "Partes recordadas",
    "{operator} stopped: the mesh or its mode has changed.":
        "{operator} se detuvo: la malla o su modo ha cambiado.",
    "{operator}: start this with the mouse over a 3D view.":
        "{operator}: iniciarlo con el ratón sobre una vista 3D.",
    "Partwheel stopped: {reason}. The full report is in the system console.":
        "Partwheel se detuvo: {reason}. El informe completo está en la consola del sistema.",
    "Wheel, ↑↓":
        "Rueda, ↑↓",
    "Confirm":
        "Confirmar",
    "Cancel":
        "Cancelar",
    "Pick a Part":
        "Elegir una parte",
    "Snap":
        "Ajustar",
    "Number":
        "Número",
    "Navigate":
        "Navegar",
    "Drag":
        "Arrastrar",
    "Within":
        "Dentro",
    "Similar":
        "Similares",
    "Copy":
        "Copiar",
    "Remove":
        "Eliminar",
    "More, Fewer":
        "Más, menos",
    "Drag or Place the Handle":
        "Arrastrar el asa o ponerla en otro lugar",
    "One More":
        "Una más",
    "Move, Rotate, Scale":
        "Mover, rotar, escalar",
    "Handle Size":
        "Tamaño del asa",
    "Wheel":
        "Rueda",
    "Confirm, Recompute Parts":
        "Confirmar y recalcular partes",
    "Axis":
        "Eje",
    "Type":
        "Escribir",
    "Precise":
        "Preciso",
    "Done":
        "Listo",
    "Shift Wheel":
        "Mayús rueda",
    "Page Up/Down":
        "Re Pág/Av Pág",
    "Next, Previous Part":
        "Parte siguiente, anterior",
    "Ctrl Wheel":
        "Ctrl rueda",
    "Swap":
        "Cambiar",
    "A Part":
        "Una parte",
    "Merge":
        "Fusionar",
    "Join, Split":
        "Unir, dividir",
    "Automatic":
        "Automático",
    "Groups":
        "Grupos",
    "Colors":
        "Colores",
    "Slots":
        "Ranuras",
    "Print":
        "Imprimir",
    "Another":
        "Otra",
    # Of the library
    "This part is no solid: it has no face of the surface. Take a larger one.":
        "Esta parte no es un sólido: no tiene ninguna cara de la superficie. Tomar una más grande.",
    "The part has no faces: pick one that has some.":
        "La parte no tiene caras: elegir una que las tenga.",
    "There are no triangles: select a part with faces.":
        "No hay triángulos: seleccionar una parte con caras.",
    "The part's faces are too thin to be deformed. Dissolve degenerate faces or merge vertices by distance first.":
        "Las caras de la parte son demasiado finas para deformarlas. Antes, disolver caras degeneradas o fusionar vértices por distancia.",
    "The mesh has no area at all: only edges and points.":
        "La malla no tiene área: solo bordes y puntos.",
    "The mesh is a sheet, not a solid: it is open, and closing it would take as much new surface as there is. Give it a thickness (Solidify), close it, or allow open surfaces, which are then taken as thin solids.":
        "La malla es una lámina, no un sólido: está abierta y cerrarla exigiría tanta superficie nueva como la que tiene. Darle grosor (Solidificar), cerrarla o permitir superficies abiertas, que se toman por sólidos finos.",
    "The surface encloses no volume. Give it some thickness.":
        "La superficie no encierra volumen. Darle algo de grosor.",
    "There is not enough memory to fill this mesh. Decimate it first.":
        "No hay memoria suficiente para llenar esta malla. Diezmarla antes.",
    "The mesh can't be filled: some faces are too close together to be told apart. Merge vertices by distance, or move the parts that almost touch further apart.":
        "La malla no se puede llenar: algunas caras están demasiado juntas para distinguirlas. Fusionar vértices por distancia o separar más las partes que casi se tocan.",
    "The mesher moved or merged vertices of the surface, for some are too close together. Merge vertices by distance.":
        "Al llenar se movieron o fusionaron vértices de la superficie, porque algunos están demasiado juntos. Fusionar vértices por distancia.",
    "The mesher lost a part of the surface. Remesh or smooth the mesh a little and try again.":
        "Al llenar se perdió una parte de la superficie. Rehacer la malla o suavizarla un poco e intentarlo de nuevo.",
    "The mesh has no faces. Choose a mesh object that has some.":
        "La malla no tiene caras. Elegir un objeto de malla que las tenga.",
    "All vertices are at the same place. Choose a mesh that has an extent.":
        "Todos los vértices están en el mismo lugar. Elegir una malla que tenga extensión.",
    "The mesh has no part that can be closed. Give it a thickness (Solidify).":
        "La malla no tiene ninguna parte que se pueda cerrar. Darle grosor (Solidificar).",
    "The surface passes through itself in ways that can't be repaired. Remesh it, or unite its parts with a Boolean.":
        "La superficie se atraviesa a sí misma de un modo que no se puede reparar. Rehacer la malla o unir sus partes con una operación booleana.",
    "The mesh can't be filled: the mesher comes to no end. Remesh or smooth it a little and try again.":
        "La malla no se puede llenar: el proceso no termina. Rehacerla o suavizarla un poco e intentarlo de nuevo.",
    "The mesh was not changed.":
        "Nada más sufrió daños; la malla está como estaba.",
    "The build was not done after {seconds} seconds of work and was stopped.":
        "La búsqueda no había terminado tras {seconds} segundos de trabajo y se detuvo.",
    "The build was not done after {seconds} seconds without any work and was stopped.":
        "La búsqueda pasó {seconds} segundos sin trabajar y se detuvo.",
    "A mesh with fewer faces (Decimate, or a voxel remesh) is faster.":
        "Una malla con menos caras (Diezmar, o un remallado por vóxeles) es más rápida.",
    "The worker process ran out of memory.":
        "El proceso de trabajo se quedó sin memoria.",
    "It may use {size:.1f} GiB.":
        "Puede usar {size:.1f} GiB.",
    "A mesh with fewer faces (Decimate, or a voxel remesh) needs less.":
        "Una malla con menos caras (Diezmar, o un remallado por vóxeles) necesita menos.",
    "Create convex hulls that fit tightly around the model, as children of it, for collisions in game engines":
        "Crear pocas envolventes convexas que contienen el modelo y poco más: hijas suyas, como los motores quieren su colisión",
    "Convex Parts":
        "Partes convexas",
    "What decides how many hulls there are":
        "Qué decide cuántas envolventes hay",
    "Number of hulls; fewer if more would not improve the fit":
        "Tantas envolventes; menos donde más no aportarían nada",
    "Error":
        "Error",
    "As few hulls as possible within this distance from the model":
        "Las menos envolventes que se encuentren que en ningún sitio se alejen más del modelo",
    "Hulls":
        "Envolventes",
    "How many":
        "Cuántas",
    "Largest distance of the hulls from the model, relative to the size of the model":
        "Cuánto pueden alejarse las envolventes del modelo: una parte de su diagonal",
    "Vertices":
        "Vértices",
    "Most vertices of a hull: physics engines accept 64 or 255":
        "De cada envolvente, como mucho: los motores de física admiten 64 o 255",
    "For":
        "Para",
    "How the hulls are named, or what they become":
        "Cómo se llaman las envolventes, o en qué se convierten",
    "Unreal":
        "Unreal",
    "Godot":
        "Godot",
    "Unity":
        "Unity",
    "Names that start with UCX: the importer uses them as the model's collision":
        "Nombres que empiezan por UCX: su importador los toma como colisión del modelo",
    "Names that end with -convcolonly: the importer creates bodies with these shapes":
        "Nombres que acaban en -convcolonly: su importador hace de ellos cuerpos con formas",
    "Names with collider, for children that get a convex Mesh Collider":
        "Nombres con collider, para hijos que allí reciben un Mesh Collider convexo",
    "Rigid Body":
        "Cuerpo rígido",
    "Blender's rigid body: the model falls and rolls with the hulls as its shape":
        "De Blender: el modelo cae y rueda, y sus envolventes son su forma",
    "{name} is linked from another file and can't be a rigid body: make it local first (Object > Relations > Make Local).":
        "{name} está vinculado desde otro archivo y no puede ser un cuerpo rígido: hazlo local primero (Objeto > Relaciones > Hacer local).",
    "The name of {name} is too long for the names of its hulls: shorten it.":
        "El nombre de {name} es demasiado largo para nombrar sus envolventes según él: acórtalo.",
    "Another object has the name {name}, which a hull needs: rename that object.":
        "Ya hay otro objeto llamado {name}, como se llamaría una envolvente: cámbiale el nombre.",
    "{count} convex hulls around {name} with {times:.2f} times its volume.":
        "{count} envolventes convexas alrededor de {name}, juntas de {times:.2f} veces su volumen.",
    "Count":
        "Cantidad",
    "Primitives":
        "Primitivas",
    "Replace a hull by a box, sphere, capsule or cylinder within this distance from it, relative as for Error; 0: hulls only":
        "Tomar una caja, esfera, cápsula o cilindro donde no se aleje más que esto de la envolvente, una parte como en Error; 0: solo envolventes",
    "The worker process {how} before it was done.":
        "El proceso de trabajo {how} antes de terminar.",
    "Merging vertices by distance, or a voxel remesh, often helps.":
        "A menudo ayuda fusionar vértices por distancia o un remallado por vóxeles.",
    "The worker process gave a damaged answer.":
        "El proceso de trabajo dio una respuesta dañada.",
    "The worker process gave a damaged answer: {reason}":
        "El proceso de trabajo dio una respuesta dañada: {reason}",
    "The worker process returned the parts of another mesh.":
        "El proceso de trabajo dio la respuesta de otra malla.",
    "There is no Python to run the worker process: {reason}.":
        "No hay ningún Python para el proceso de trabajo: {reason}.",
    "The worker process could not be started: {reason}.":
        "No se pudo iniciar el proceso de trabajo: {reason}.",
    "The worker process did not begin in {seconds} seconds.":
        "El proceso de trabajo no empezó en {seconds} segundos.",
    "The worker process {how} before it began.":
        "El proceso de trabajo {how} antes de empezar.",
    "If this happens again, choose a Python 3 to run it: Python in the add-on's preferences, or the argument python.":
        "Si sigue así, indicar qué Python 3 debe ejecutarlo: Python en las preferencias del complemento o el argumento python.",
    "was killed (SIGKILL, possibly because memory ran out)":
        "fue eliminado (SIGKILL, quizá por falta de memoria)",
    "crashed ({reason})":
        "falló ({reason})",
    "was interrupted (Ctrl-C)":
        "fue terminado desde fuera (Ctrl C)",
    "ended without an answer (exit code {code})":
        "terminó sin respuesta (código de salida {code})",
    "did not answer in {seconds} seconds":
        "no respondió en {seconds} segundos",
    "can't be started ({reason})":
        "no se puede iniciar ({reason})",
    "there is none":
        "no hay ninguno",
    "Remove the parts of the active mesh, also those saved with the file. The mesh stays as it is":
        "Elimina las partes de la malla activa, también las guardadas con el archivo. La malla queda como está",
    "{name} no longer has a part similar to {part}. Pick the part again, forget the name {part}, and remember the part under this name.":
        "{name} ya no tiene una parte parecida a {part}. Elegir la parte de nuevo, olvidar el nombre {part} y recordar la parte con ese nombre.",
    "{name} has no remembered part {part}. Pick the part, and name it with Remember Part.":
        "{name} no tiene una parte recordada {part}. Elegir la parte y darle un nombre con Recordar parte.",
    "{name} has a Multiresolution modifier, whose details would be lost. Apply the modifier first.":
        "{name} tiene un modificador Multirresolución, cuyos detalles se perderían. Aplicar antes el modificador.",
    "{name} has a Multiresolution modifier: the new objects have only its coarsest level. To keep the details, apply the modifier first.":
        "{name} tiene un modificador Multirresolución: los objetos nuevos solo tienen su nivel más bajo. Para conservar los detalles, aplicar antes el modificador.",
    "Duplicate Selection":
        "Duplicar selección",
    "The mesh is too broken for this. Remesh it and try again.":
        "La malla está demasiado dañada para esto. Aplicar Remallar e intentarlo de nuevo.",
    "So many triangles pass through each other that the inside can't be found. Remesh the model, or unite its parts with a Boolean.":
        "Tantos triángulos se atraviesan que no se puede determinar el interior. Aplicar Remallar o unir las partes con un booleano.",
    "There is not enough memory. Close other programs, or decimate the mesh.":
        "No hay suficiente memoria. Cerrar otros programas o diezmar la malla.",
    "No vertex is free to deform: the handle must be smaller than the part, and connected with it.":
        "Ningún vértice puede deformarse: el asa debe ser más pequeña que la parte y estar conectada con ella.",
    "The shape keys of {names} are lost; the parts keep their current shape. The shape keys of {target} move only its own surface.":
        "Las formas clave de {names} se pierden; las partes conservan su forma actual. Las formas clave de {target} solo mueven su propia superficie.",
    "The model has {count:,} duplicate faces. The objects contain each of them once.":
        "El modelo tiene {count:,} caras duplicadas. Los objetos contienen cada una una sola vez.",
    "The volumes of the objects add up to {total:.4g}, but the model's volume is {whole:.4g}, because its surface is broken. Repair the mesh, or turn off Closed.":
        "Los volúmenes de los objetos suman {total:.4g}, pero el del modelo es {whole:.4g}, porque su superficie está dañada. Reparar la malla o desactivar Cerrados.",
    "Only the mesh of {name} itself is printed, without the effect of its modifiers. To print it, apply them first.":
        "Solo se imprime la malla de {name}, sin el efecto de sus modificadores. Para imprimirlo, aplicar antes los modificadores.",
    "How the part follows the handle":
        "Cómo sigue la parte al asa",
    "How the parts change the current selection":
        "Cómo cambian las partes la selección actual",
    "The part is the whole model, which has no other side. Pick a smaller one.":
        "La parte es todo el modelo, que no tiene otro lado. Elegir una más pequeña.",
    "The part is the whole model: nothing would be left without it. Pick a smaller one.":
        "La parte es todo el modelo: sin ella no quedaría nada. Elegir una más pequeña.",
    "The scene is linked from another file, so no object can be added to it.":
        "La escena está vinculada desde otro archivo, así que no se le pueden agregar objetos.",
    "The modifier {modifier} is bound to the vertices of {name}, which change: bind it again afterwards.":
        "El modificador {modifier} está vinculado a los vértices de {name}, que cambian: volver a vincularlo después.",
    "The selection must be exactly one whole part. Pick the part again with Select Part by Wheel, and confirm it.":
        "La selección debe ser exactamente una parte completa. Elegir la parte de nuevo con Seleccionar parte con la rueda y confirmarla.",
    "New Part":
        "Parte nueva",
}
