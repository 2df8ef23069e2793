# SPDX-License-Identifier: GPL-3.0-or-later
"""Chinese, simplified."""

WORDS = {
    "Turn":
        "旋转",
    "About the border's normal":
        "绕边界法线旋转",
    "Depth":
        "深度",
    "How deep the part sinks in, in radii of its border":
        "嵌入的深度，以其边界半径为单位",
    "size {size:.2f}, turn {turn:.0f}°, depth {depth:.2f}":
        "大小 {size:.2f}，旋转 {turn:.0f}°，深度 {depth:.2f}",
    "Place Part":
        "放置部件",
    "Place the active part on a surface: it follows the mouse with its border on the surface":
        "将活动部件放置到表面上：部件跟随鼠标，边界贴合表面并朝向表面",
    "{operator} stopped: the part is no longer the active object.":
        "{operator} 已停止：该部件不再是活动物体。",
    "Onto":
        "目标",
    "The object that the part is placed on":
        "放置部件的物体",
    "Location":
        "位置",
    "Location of the part's border":
        "边界所在的位置",
    "Normal":
        "法向",
    "Normal of the surface at the location":
        "该处表面的法线",
    "Size":
        "大小",
    "Factor of the part's size":
        "相对原有大小的倍数",
    "Fit Border":
        "贴合边界",
    "Fit the part to the target's nearest border, where a part was removed":
        "贴合到目标上最近的、曾移除部件的边界，并采用其大小",
    "Mirror Copy":
        "镜像副本",
    "Add the mirror image across the target's own X axis":
        "添加沿目标自身 X 轴的镜像",
    "In Object Mode, make the part that you want to place the active object.":
        "请在物体模式下，将要放置的部件设为活动物体。",
    "Choose the mesh object to place the part on.":
        "请指定部件要放置到哪个网格物体上。",
    "Move the mouse over a surface":
        "将鼠标移到表面上",
    "There is no surface under the mouse yet":
        "鼠标下还没有表面",
    "Onto {name}":
        "位于 {name}",
    "fitted":
        "已贴合",
    "with mirror copy":
        "带镜像副本",
    "{name} has no border to fit: no part was removed from it.":
        "{name} 没有可贴合的边界：没有从中移除过部件。",
    "Swap with Compatible Part":
        "交换为兼容部件",
    "Exchange the picked part for one of another object that fits its border; the wheel goes through the candidates":
        "将选取的部件换成其他物体中适合其边界的部件；滚轮切换可用的部件",
    "{operator} stopped: the object is no longer the active one.":
        "{operator} 已停止：该物体不再是活动物体。",
    "From":
        "来源",
    "The object that the new part comes from; none: the other selected objects, or else all others":
        "新部件所来自的物体；空：选中的物体，否则为其他所有物体",
    "Part":
        "部件",
    "Number of the new part in its object; -1: the most compatible part":
        "新部件在该物体中的编号；-1：最兼容的部件",
    "Factor of the size at which the borders fit":
        "相对边界相符时大小的倍数",
    "Mirror":
        "镜像",
    "Use the part's mirror image":
        "使用部件的镜像",
    "Blend":
        "混合",
    "Width of a smooth transition on either side of the seam, in radii of the seam":
        "接缝两侧平滑过渡的宽度，以接缝半径为单位",
    "Find Parts":
        "查找部件",
    "Find the parts of the new mesh afterwards, in the background":
        "立即在单独的进程中查找新网格的部件",
    "There is no mesh object {name}.":
        "没有名为 {name} 的网格物体。",
    "{name}, part {number} of {count}, {likeness:.0%} similar":
        "{name}，部件 {number} / {count}，相似度 {likeness:.0%}",
    "mirrored":
        "已镜像",
    "Leave Edit Mode":
        "离开编辑模式",
    "The part is the whole model: nothing would be left to put another part on. Pick a smaller one.":
        "该部件是整个模型：没有剩余部分可供放置其他部件。请选取更小的部件。",
    "The part has no border with the rest of the model, so no other part can be fitted to it. Pick a part that is connected to the rest.":
        "该部件与模型其余部分没有边界，因此无处可贴合其他部件。请选取从模型上长出的部件，而不是独立的块。",
    "No other object has parts. Find the parts of the object that the new part comes from, and select this object, too; or paste a part that was copied as a solid.":
        "没有其他物体有部件。请查找新部件来源物体的部件并一同选中；或粘贴一个复制为实体的部件。",
    "No part there has a border that fits the picked part's.":
        "没有部件的边界能与此部件的边界贴合。",
    "{name} has no part {number}.":
        "{name} 没有部件 {number}。",
    "That part of {name} has no border that fits the picked part's.":
        "{name} 的该部件没有能与此部件贴合的边界。",
    "{name} has changed and has other parts now. Start again.":
        "{name} 已更改，现在有不同的部件。请重新开始。",
    "it has no faces":
        "没有面",
    "{count} edges don't have exactly two faces":
        "{count} 条边不是恰好连接两个面",
    "{count} edges have faces of opposite orientation":
        "{count} 条边上的面方向相反",
    "{count} vertices are loose or connect parts that only touch there":
        "{count} 个顶点是松散的，或连接仅在该处接触的部分",
    "{name} is not a solid: {reason}. Repair it, or copy the part again.":
        "{name} 不是实体：{reason}。请修复，或重新复制其部件。",
    "{name} is not a solid: it is inside out. Turn its faces outside (Recalculate Outside).":
        "{name} 不是实体：内外翻转了。请将面朝外（重新计算外侧）。",
    "by {solver} within: {reason}":
        "{solver}（含内部）：{reason}",
    "by {solver}: {reason}":
        "{solver}：{reason}",
    "{one} and {other} can't be united ({reasons}). Move one of them a little: overlapping coplanar faces are the usual cause.":
        "无法合并 {one} 与 {other}（{reasons}）。请稍微移动其中一个：通常是因为有面互相重叠。",
    "its volume would be {share:.0%} of the sum of both volumes":
        "其体积将为两者之和的 {share:.0%}",
    "one of them is missing":
        "其中一个被遗漏",
    "In Object Mode, select the parts, and then the mesh object to unite them with.":
        "请在物体模式下，先选择部件，再选择要并入的网格物体。",
    "Unite Solids":
        "合并实体",
    "Unite the other selected solids with the active one into a single closed mesh":
        "将其他选中的实体与活动实体合并为一个封闭网格",
    "Width of a smooth transition on either side of each seam, in radii of the seam; 0: the seam stays a crease":
        "每条接缝两侧平滑过渡的宽度，以接缝半径为单位；0：接缝保持折痕",
    "Find the parts of the united mesh afterwards, in the background":
        "立即在单独的进程中查找合并后网格的部件",
    "Keep Parts":
        "保留部件",
    "Keep the other objects":
        "保持其他物体不变",
    "{name} is now one closed mesh with {count:,} faces (solver {solver}).":
        "{name} 现在是一个封闭网格，有 {count:,} 个面（解算器 {solver}）。",
    "The vertex group {name} is locked. Unlock it, or give it another name.":
        "顶点组 {name} 已锁定。请解锁，或改用其他名称。",
    "Face Sets":
        "面组",
    "One for each part; they replace the existing ones":
        "每个部件一个，替换现有的全部",
    "Vertex Groups":
        "顶点组",
    "For an armature: smooth across the borders, with a sum of 1":
        "用于骨架：在边界处平滑衰减，总和为 1",
    "Colored Materials":
        "彩色材质",
    "A material with a color of its own for each part":
        "每个部件一个不同颜色的材质",
    "Material Slots":
        "材质槽",
    "The model's own materials, with a slot for each part":
        "模型自身的材质，每个部件一个槽",
    "Seams":
        "缝合边",
    "For unwrapping: along the borders, in creases, and where a part would not lie flat":
        "用于展开：沿边界、在折痕处以及部件无法展平之处",
    "Objects":
        "物体",
    "Each part becomes an object, parented to its neighbor":
        "每个部件成为一个物体，以相邻部件为父级",
    "Bones":
        "骨骼",
    "An armature with a bone for each part, and its vertex groups, ready to pose":
        "每个部件一根骨骼的骨架及其顶点组，可直接摆姿势",
    "For Printing":
        "用于打印",
    "Closed objects with flat cuts, pegs and sockets, checked. Needs manifold3d":
        "经过检查的封闭物体，带平整切面、销钉和插孔。需要 manifold3d",
    "Parts to...":
        "部件转为...",
    "Divide the whole model into parts: the wheel changes the number, a click and the wheel one part, a drag merges":
        "将整个模型分为部件：滚轮更改数量，点击加滚轮更改单个部件，拖动可合并",
    "Create":
        "创建",
    "What to create from the parts; none: only save them in the mesh":
        "部件转换的结果；无：仅保存在网格中",
    "Parts":
        "部件",
    "Number of parts; 0: the parts saved in the mesh, or the automatic segmentation":
        "数量；0：保存在网格中的部件，或人们最可能的划分",
    "Closed":
        "封闭",
    "Close the objects where they were cut, so that they are solids that add up to the whole":
        "封闭物体的切口：成为组成整体的实体",
    "Smooth Caps":
        "平滑封盖",
    "Close the objects with a smooth surface instead of flat facets":
        "用平滑的表面封闭，而不是内部与其余部分分隔的平面",
    "Cap Material":
        "封盖材质",
    "Give the caps a material of their own":
        "为封盖指定单独的材质",
    "Origins at Borders":
        "原点在边界",
    "Place the origin of each object at the center of its border":
        "每个物体绕其边界的中心旋转",
    "Explode":
        "爆炸",
    "Distance by which the objects move apart, times the distance of their centers. You can change it later in a custom property of the largest object":
        "按中心间距将部件移开的程度。最大的物体也将其作为自定义属性，可以之后更改",
    "Shell":
        "外壳",
    "Thickness of the walls, by a modifier; 0: solid":
        "由修改器生成的壁厚；0：实心",
    "Unwrap":
        "展开",
    "Unwrap the mesh along the seams, into a new UV map if there are others":
        "沿缝合边展开网格，若已有其他 UV 贴图则展开到新的 UV 贴图",
    "Pegs":
        "销钉",
    "Add a peg and a socket across each cut, where there is room":
        "在有空间的每个切口处添加销钉和插孔",
    "Clearance (mm)":
        "间隙 (mm)",
    "The gap around each peg, on all sides":
        "每个销钉四周的间隙",
    "Wall (mm)":
        "壁厚 (mm)",
    "Minimum thickness of the walls around a socket; a message reports thinner walls":
        "插孔周围保留的厚度；更薄的壁会提示",
    "Bed (mm)":
        "打印床 (mm)",
    "Size of the printer's bed: larger parts are split further; 0: no limit":
        "打印机的打印床：更大的部件会继续分割；0：足够大",
    "Hide Original":
        "隐藏原物体",
    "Hide the object that was divided":
        "隐藏被分割的物体",
    "This is for an active mesh object, in Object, Edit or Sculpt Mode.":
        "需要处于物体、编辑或雕刻模式的活动网格物体。",
    "Dynamic topology changes the faces all the time: turn it off first.":
        "动态拓扑会不断改变面：请先将其关闭。",
    "These are not parts of {name}: {reason}":
        "这些不是 {name} 的部件：{reason}",
    "{name} now has {count} parts: {results}.":
        "{name} 现在分为 {count} 个部件：{results}。",
    "{count} parts: {results}":
        "{count} 个部件：{results}",
    "{count} parts, one of {faces:,} faces: {results}":
        "{count} 个部件，其中一个有 {faces:,} 个面：{results}",
    "Saved in the Mesh":
        "保存在网格中",
    "Printing needs the Python package manifold3d, which Blender doesn't have. To install it, run: {python} -m pip install manifold3d.":
        "打印需要 Python 包 manifold3d，而 Blender 未包含。安装方法，运行：{python} -m pip install manifold3d。",
    "The scale of {name} is not uniform: apply its scale first.":
        "{name} 沿各轴的缩放不同：请先应用缩放。",
    "{name} has {count} UV maps, the most that Blender allows: remove one.":
        "{name} 有 {count} 个 UV 贴图，无法再添加：请移除一个。",
    "Handle of one vertex":
        "1 个顶点的手柄",
    "Handle of {count:,} vertices":
        "{count:,} 个顶点的手柄",
    "The whole part":
        "整个部件",
    "Joint of {reach:.1f} radii":
        "{reach:.1f} 倍半径的关节",
    "The handle covers the whole part, so nothing is left to follow it: make the handle smaller.":
        "手柄占据了整个部件，没有可跟随的部分：请缩小手柄。",
    "One handle covers another: make it smaller or move it.":
        "手柄互相覆盖：请缩小，或放到其他位置。",
    "No visible part of this limb is beyond its joint: make the joint smaller.":
        "该部分在关节之外没有可见的顶点：请缩小关节。",
    "Move":
        "移动",
    "Rotate":
        "旋转",
    "Scale":
        "缩放",
    "{movement} along local {axes}":
        "{movement} 沿局部 {axes} 轴",
    "{movement} along global {axes}":
        "{movement} 沿全局 {axes} 轴",
    "{movement} in local {axes}":
        "{movement} 在局部 {axes} 平面",
    "{movement} in global {axes}":
        "{movement} 在全局 {axes} 平面",
    "Vertex":
        "顶点",
    "Radius":
        "半径",
    "Matrix":
        "矩阵",
    "Deform Part":
        "变形部件",
    "Drag a handle of the last picked part: the part follows like a soft body, and the rest of the mesh stays in place":
        "拖动上次选取部件的手柄：部件像软体一样跟随，其外的一切保持不变",
    "Number of the part; -1: the last pick":
        "部件的编号；-1：上次选取的部件",
    "Method":
        "方法",
    "As Rigid as Possible":
        "尽可能刚性",
    "The part follows the handle and keeps its details":
        "部件跟随手柄并保留细节",
    "Proportional":
        "比例化",
    "The part moves as a whole, less toward its border":
        "部件整体移动，越靠近边界移动越少",
    "At the Joint":
        "在关节处",
    "The part keeps its shape and turns at its border; the mesh near the border bends":
        "部件保持形状并绕其边界旋转；边界两侧附近会弯曲",
    "Rings":
        "环",
    "Rings of faces around the part that deform with it, for a softer transition":
        "部件周围随之变形的面环数，使衔接更柔和",
    "Joint":
        "关节",
    "Distance from the border within which the mesh bends, in radii of the border":
        "从部件边界起弯曲的范围，以边界半径为单位",
    "Snap Border":
        "吸附边界",
    "Deform the part up to the creases near its border instead of its own border; on for picks with a snapped border":
        "变形到部件边界附近的折痕，而不是部件自身的边界；与以此方式选取的部件相同",
    "Deform parts in Edit Mode of a mesh.":
        "部件变形需在网格的编辑模式下进行。",
    "There is no handle: drag one in the 3D view.":
        "没有手柄：请在 3D 视图中拖动一个。",
    "The mesh doesn't have the vertex of a handle.":
        "手柄的顶点在网格中不存在。",
    "{state}: settling":
        "{state}：正在稳定",
    "{state}: getting ready":
        "{state}：正在准备",
    "Move Part Proportionally":
        "比例移动部件",
    "Move the last picked part; its surroundings follow, depending on its size. R rotates and S scales it":
        "移动上次选取的部件；周围按其大小跟随。R 旋转，S 缩放",
    "The part has no visible vertex inside its border: pick a larger one.":
        "部件的边界内没有可见的顶点：请选取更大的部件。",
    "The part is the whole mesh or a loose piece, without a border that would stay fixed: pick a smaller one, or move it with Blender's own tools.":
        "该部件是整个网格或其中松散的一块，没有可固定的边界：请选取更小的部件，或直接移动。",
    "The faces of the part have no area: there is nothing to deform.":
        "部件的面没有面积：没有可变形的内容。",
    "This point is not on the part.":
        "该处不是部件上的点。",
    "The mesh of {name} is linked from another file: make it local first (Object > Relations > Make Local).":
        "{name} 的网格链接自其他文件：请先设为本地（物体 > 关系 > 设为本地）。",
    "The mesh of {name} is a library override, which Blender does not edit: make it local first (Object > Relations > Make Local).":
        "{name} 的网格是库重写，Blender 不会编辑：请先设为本地（物体 > 关系 > 设为本地）。",
    "This is for an active mesh object, in Edit Mode or Object Mode.":
        "需要处于编辑模式或物体模式的活动网格物体。",
    "The build was canceled.":
        "查找已取消。",
    "The mesh {name} was deleted, so its parts were discarded.":
        "网格 {name} 已不存在，因此放弃其部件。",
    "{name} was edited while its parts were being found, so they were discarded. Find them again after editing.":
        "{name} 在查找部件期间被编辑，因此放弃其部件。网格完成后请重新查找。",
    "The selection is not a part. Pick one with Select Part by Wheel, and confirm it.":
        "选中的不是部件。请用“滚轮选择部件”选取并确认。",
    "No part is picked. Pick one with Select Part by Wheel, and confirm it.":
        "尚未选取部件。请用“滚轮选择部件”选取并确认。",
    "There is no part {number}: there are {count}.":
        "没有部件 {number}：共有 {count} 个。",
    "{name} has no parts for its current mesh. Find them first.":
        "{name} 的当前网格没有部件。请先查找。",
    "The parts saved with {name} come from a newer version of Partwheel, so they are found again. Update Partwheel to use the saved parts.":
        "与 {name} 一同保存的部件来自更新版本的 Partwheel，因此将重新查找。更新 Partwheel 即可使用文件中的部件。",
    "Partwheel finds the parts of {name} after those of {other}":
        "Partwheel 将在 {other} 之后查找 {name} 的部件",
    "Partwheel finds the parts of {name}: {fraction:.0%}":
        "Partwheel 正在查找 {name} 的部件：{fraction:.0%}",
    "Esc: Cancel":
        "Esc：取消",
    "Canceled: no parts were found.":
        "已取消：未找到部件。",
    "To do so, use the panel Partwheel in the sidebar.":
        "侧栏中的 Partwheel 面板可以完成此操作。",
    "No parts for {name}: {reason}":
        "{name} 没有部件：{reason}",
    "A method that was tried first failed: {reason}":
        "首先尝试的方法失败：{reason}",
    "{name}, {count:,} faces: its parts were found in {seconds:.1f} s.":
        "{name}，{count:,} 个面：在 {seconds:.1f} 秒内找到部件。",
    "Quality":
        "质量",
    "0 is fastest and right for nearly all meshes. From 1.1 on, the inside is divided more evenly (1.4 is usual, smaller is slower)":
        "0 最快，几乎适用于所有情况；从 1.1 起内部划分更均匀（通常为 1.4，越小越慢）",
    "Exactly":
        "精确",
    "Find the parts of a mesh with more than 200,000 triangles at full resolution, not on a coarser copy. Takes about ten times the time and memory. The add-on's preferences can set this for all meshes":
        "对超过 200,000 个三角形的网格，在全部三角形上而不是较粗的副本上查找部件：时间和内存约为十倍。插件偏好设置可对所有网格启用",
    "Find Parts of Mesh":
        "查找网格的部件",
    "Find the parts of the active mesh, and of other selected ones that have none, at all sizes for the wheel":
        "查找活动网格以及其他没有部件的选中网格的部件，各种大小供滚轮切换",
    "Find the parts of a mesh that another operator has just created; that operator stays the last operation, with its panel":
        "代表创建网格的操作项执行同样的操作，该操作项及其面板仍为上一步操作",
    "Clear Parts":
        "清除部件",
    "The active object has no parts.":
        "活动物体没有部件。",
    "Part under the Mouse":
        "鼠标下的部件",
    "Face Set":
        "面组",
    "Mask":
        "遮罩",
    "Vertex Group":
        "顶点组",
    "Paint Mask":
        "绘制遮罩",
    "Part by Wheel":
        "滚轮部件",
    "Pick a part with a click and the mouse wheel, and make it a face set, a mask or a vertex group":
        "用点击和滚轮选取部件，并将其设为面组、遮罩或顶点组",
    "What the part becomes":
        "部件转换的结果",
    "A new face set":
        "新的面组",
    "Masked against sculpting":
        "不受雕刻影响",
    "Weight 1 in a new vertex group named after the part; Extend adds it to the active group, Deselect removes it from there":
        "以部件命名的新顶点组，权重为 1；扩展时加入活动顶点组，取消选择时从中移除",
    "The only faces that can be painted on":
        "只能在这些面上绘制",
    "This is for Sculpt Mode and the paint modes of a mesh.":
        "需要处于网格的雕刻模式或绘制模式。",
    "In this mode, parts can't become this: {results}.":
        "此模式下部件不能转为：{results}。",
    "Face":
        "面",
    "The face that was clicked":
        "被点击的面",
    "Level":
        "级别",
    "Notches of the wheel from the part that the click selects; up is positive":
        "从点击所选部件起的滚轮格数：向上为正",
    "Extend":
        "扩展",
    "Add the part to the selection instead of replacing it":
        "将部件添加到选择项，而不是替换",
    "Deselect":
        "取消选择",
    "Remove the part from the selection":
        "从选择项中移除部件",
    "Move the border of the part into nearby creases":
        "将部件的边界移到附近的折痕",
    "Face {number} can't be picked: {reason}":
        "无法选取面 {number}：{reason}",
    "This 3D view does not show the mesh that is being edited.":
        "此 3D 视图未显示正在编辑的网格。",
    "Click a face of the mesh":
        "点击网格的一个面",
    "The face there was generated by the modifiers of {name} and belongs to no face of its mesh.":
        "所见之处由 {name} 的修改器生成，不属于其网格的任何面。",
    "The parts are found. Start {operator} again to pick them.":
        "已找到部件。再次启动 {operator} 即可选取。",
    "Partwheel stopped: the parts were found again. Pick one of them.":
        "Partwheel 已停止：部件已重新查找。请选取其中之一。",
    "There is no face there":
        "该处没有面",
    "Part {number} of {count}, {faces:,} faces, {share} of the area":
        "部件 {number} / {count}，{faces:,} 个面，占面积 {share}",
    "border in creases":
        "边界在折痕处",
    "Select Part by Wheel":
        "滚轮选择部件",
    "Pick a part of the mesh with a click, then make it larger or smaller with the mouse wheel":
        "点击选取网格的部件，然后用鼠标滚轮放大或缩小",
    "Select parts in Edit Mode of a mesh.":
        "部件选择需在网格的编辑模式下进行。",
    "Pick a part of the mesh under the mouse in Object Mode, then enter Edit Mode with the part selected":
        "选取鼠标下网格的部件（期间网格保持不变），然后带着该部件进入编辑模式",
    "This is for Object Mode.":
        "需要处于物体模式。",
    "There is no mesh under the mouse.":
        "鼠标下没有网格。",
    "{name} is an instance, and this 3D view does not show its original: edit it there.":
        "{name} 是实例，此 3D 视图未显示其原物体：请在原处编辑。",
    "Toggle Edit Mode":
        "切换编辑模式",
    "Select Part":
        "选择部件",
    "Select a meaningful part of the mesh.\nClick a part, then turn the wheel for the next larger or smaller one. Shift adds, Ctrl removes":
        "选择网格中有意义的部件。\n点击部件，然后转动滚轮切换到更大或更小的部件。Shift 添加，Ctrl 移除",
    "Parts are found at the first click":
        "部件将在首次点击时查找",
    "Pick a meaningful part of a mesh.\nClick a part, then turn the wheel for the next larger or smaller one. Shift adds, Ctrl removes":
        "拾取网格中有意义的部件。\n点击部件，然后转动滚轮切换到更大或更小的部件。Shift 添加，Ctrl 移除",
    "Mask a meaningful part of the mesh, or make it a face set.\nClick a part, then turn the wheel for the next larger or smaller one. Shift adds, Ctrl removes":
        "为网格中有意义的部件添加遮罩，或将其设为面组。\n点击部件，然后转动滚轮切换到更大或更小的部件。Shift 添加，Ctrl 移除",
    "Make a meaningful part of the mesh a vertex group.\nClick a part, then turn the wheel for the next larger or smaller one. Shift adds, Ctrl removes":
        "将网格中有意义的部件设为顶点组。\n点击部件，然后转动滚轮切换到更大或更小的部件。Shift 添加，Ctrl 移除",
    "Paint only on a meaningful part of the mesh.\nClick a part, then turn the wheel for the next larger or smaller one. Shift adds, Ctrl removes":
        "仅在网格中有意义的部件上绘制。\n点击部件，然后转动滚轮切换到更大或更小的部件。Shift 添加，Ctrl 移除",
    "Select all parts that a box touches, at the level of the last pick.\nShift adds, Ctrl removes. A click picks a part as with Select Part":
        "选择矩形框触及的所有部件，级数与上次拾取的部件相同。\nShift 添加，Ctrl 移除。点击则如“选择部件”一样拾取部件",
    "Select all parts that a lasso touches, at the level of the last pick.\nShift adds, Ctrl removes. A click picks a part as with Select Part":
        "选择套索触及的所有部件，级数与上次拾取的部件相同。\nShift 添加，Ctrl 移除。点击则如“选择部件”一样拾取部件",
    "Select all parts (segments, regions) that a box touches, at the level of the last pick":
        "选择矩形框触及的所有部件（分段、区域），级数与上次拾取的部件相同",
    "Select all parts (segments, regions) that a lasso touches, at the level of the last pick":
        "选择套索触及的所有部件（分段、区域），级数与上次拾取的部件相同",
    "Select Parts by Box":
        "框选部件",
    "Select Parts by Lasso":
        "套索选择部件",
    "Select the whole parts that a gesture touched":
        "将手势所选内容变为其触及的完整部件",
    "Mode":
        "模式",
    "Set":
        "设置",
    "Select these parts and nothing else":
        "仅选择这些部件",
    "Add these parts to the selection":
        "添加到所选内容",
    "Subtract":
        "减去",
    "Remove these parts from the selection":
        "从所选内容中移除",
    "Parts: Store Selection":
        "部件：所选内容",
    "Whole Parts":
        "完整部件",
    "Store the current selection":
        "记住所选内容",
    "Pick Part by Wheel":
        "滚轮拾取部件",
    "Pick a part of the mesh under the mouse to copy, swap or divide it; it is also selected in Edit Mode":
        "拾取鼠标下网格的部件，用于复制、替换或划分；在编辑模式下它处于选中状态",
    "A mask in Sculpt Mode, a vertex group in Weight Paint, else a paint mask":
        "雕刻模式下为遮罩，权重绘制下为顶点组，否则为绘制遮罩",
    "When the wheel resizes the part, after a click with the tool":
        "用工具点击之后，滚轮何时放大和缩小部件",
    "At the Click":
        "点击处",
    "While the mouse stays at the click; elsewhere the wheel zooms as usual":
        "鼠标停在点击处时；在其他位置照常缩放视图",
    "Until Enter":
        "直到按回车",
    "Wherever the mouse is, until Enter or another key ends it":
        "无论鼠标在何处，直到回车或其他按键结束",
    "Buttons":
        "按钮",
    "Show two buttons beside the click, larger and smaller. With a pen they are always shown":
        "在点击处旁显示放大和缩小两个按钮。使用压感笔时始终显示",
    "Blender would not undo a mask of the multires modifier's levels. Make the part a face set instead: the tool's header and the menu Face Sets have it.":
        "Blender 无法撤销多级精度修改器各级别上的遮罩。请改为将部件设为面组：工具标题栏和面组菜单中有此选项。",
    "Overlay":
        "叠加层",
    "The vertex group {name} is locked. Unlock it, or pick the part alone: it gets a group of its own.":
        "顶点组 {name} 已锁定。请解锁，或单独选取部件：它将获得自己的顶点组。",
    "{name} has no vertex group that the part could be removed from.":
        "{name} 没有可移除部件的顶点组。",
    "The part was removed from the vertex group {name}.":
        "已从顶点组 {name} 中移除部件。",
    "The part was added to the vertex group {name}.":
        "已将部件添加到顶点组 {name}。",
    "The part is the new vertex group {name}.":
        "部件成为新的顶点组 {name}。",
    "Find on Import":
        "导入时查找",
    "Find the parts of imported and appended meshes at once, while you keep working":
        "导入或追加的内容会立即在您工作的同时查找部件",
    "Find Parts of Imported Meshes":
        "查找导入网格的部件",
    "Find the parts of newly imported meshes":
        "为导入操作查找所选网格中尚无部件者的部件",
    "Select meshes without parts, in Object Mode.":
        "此功能用于物体模式下所选的尚无部件的网格。",
    "Save Parts in .blend Files":
        "在 .blend 文件中保存部件",
    "Save the parts of meshes with the file, so that they need not be found again. The file grows by about 40 bytes per face":
        "打开文件时恢复已找到的部件。每个面约增加 40 字节",
    "How the next builds merge small parts into larger ones":
        "今后查找时，小部件如何合并为更大的部件",
    "As People See Them":
        "如人所见",
    "Learned from the parts that people chose on some hundred models: a click alone finds the intended part more often. Borders follow creases, and symmetric models get symmetric parts":
        "依据人们在数百个模型上对部件的划分：仅点击就更常找到想要的部件。边界位于折痕处，对称模型的两侧相同",
    "Nearly Convex":
        "近似凸",
    "By convexity alone, the most regular and fastest method: a click selects the smallest part, and each notch of the wheel takes one step":
        "仅依据凸性，最规则也最快：点击选取最小的块，滚轮每格前进一步",
    "Large Meshes at Full Resolution":
        "大型网格精确查找",
    "Find the parts of meshes with more than 200,000 triangles at full resolution, not on a coarser copy. Takes about ten times the time and memory, for mostly the same parts":
        "对超过 200,000 个三角形的网格，在全部三角形上而不是较粗的副本上查找部件：时间和内存约为十倍，部件大多相同",
    "Memory":
        "内存",
    "Share of the available memory that a build may use (enforced on Linux)":
        "查找可使用的可用内存比例（在 Linux 上遵守）",
    "Time Limit":
        "时间限制",
    "Minutes of processor time after which a build is stopped. 0: two, plus two for each 60,000 triangles, far more than builds need":
        "超过此处理器时间（分钟）后停止查找；0：两分钟，每 60,000 个三角形再加两分钟，远超所需",
    "Python":
        "Python",
    "The Python 3 program that runs builds in a separate process. Empty: the one in Blender, or else an installed one":
        "在单独进程中查找部件的程序，需为 Python 3；空：Blender 自带的，否则为已安装的",
    "Tint the picked part":
        "为当前部件着色",
    "Next Part":
        "下一个部件",
    "Tint faintly what the next notch of the wheel adds":
        "为滚轮下一格所添加的部分淡淡着色",
    "Convex Hull":
        "凸壳",
    "Show the convex hull of the picked part as glass":
        "以玻璃形式显示当前部件的凸壳",
    "All Parts":
        "所有部件",
    "Show all parts of the mesh at the size of the picked part, each in its own color":
        "以当前部件的大小显示整个网格的部件，每个一种颜色",
    "Pie Menu":
        "饼菜单",
    "The part has no mirror image in {name}: it crosses the symmetry plane, or the model is not symmetric.":
        "该部件在 {name} 中没有镜像：它跨越对称平面，或模型两侧不同。",
    "Remember parts in Edit Mode of a mesh.":
        "记住部件需在网格的编辑模式下进行。",
    "Name of the remembered part":
        "记住部件所用的名称",
    "Remember Part":
        "记住部件",
    "Name the last picked part (segment, region), so that you can select it again from the panel's list":
        "为上次选取的部件（分段、区域）命名，面板列表可凭此名称再次选择",
    "Name":
        "名称",
    "The part's name":
        "部件的名称",
    "Part {number}":
        "部件 {number}",
    "Select Remembered Part":
        "选择记住的部件",
    "Select the remembered part. Shift adds it to the selection, Ctrl removes it":
        "选择以此名称记住的部件。Shift 添加到选择项，Ctrl 从中移除",
    "Rename Part":
        "重命名部件",
    "Rename a remembered part":
        "为记住的部件改名",
    "New Name":
        "新名称",
    "New name of the part":
        "部件今后的名称",
    "Forget Part":
        "忘记部件",
    "Forget a remembered part; the mesh does not change":
        "忘记部件的名称；网格保持不变",
    "Enter a name for the part.":
        "部件以名称记住：名称不能为空。",
    "The name {name} is too long: use at most {count} letters, fewer in some scripts.":
        "{name} 作为名称过长：最多 {count} 个字母，某些文字更少。",
    "There already is a remembered part {name}. Enter another name, or forget that part first.":
        "已有部件以 {name} 记住。请换一个名称，或先忘记该部件。",
    "Add to the selection instead of replacing it":
        "添加到选择项，而不是替换",
    "Select Similar Parts":
        "选择相似部件",
    "Select all parts (segments, regions) similar to the last pick, in all edited objects: fingers, legs, horns":
        "在每个正在编辑的物体中选择与上次选取的部件相似的所有部件（分段、区域）：手指、腿、角",
    "Not searched, since they have no parts yet: {names}. Find their parts first.":
        "以下物体还没有部件，因此未搜索：{names}。请先查找部件。",
    "Threshold":
        "阈值",
    "Minimum similarity of selected parts: 1 is the same shape and size; lower values select more parts":
        "所选部件的相似程度：1 为形状和大小相同，越小部件越多",
    "{count} parts, similarity at least {threshold:.2f}":
        "{count} 个部件，相似度不低于 {threshold:.2f}",
    "Select Mirrored Part":
        "选择镜像部件",
    "Select the part (segment, region) on the other side of the model, across its own plane of symmetry":
        "选择模型另一侧、关于其自身对称平面的部件（分段、区域）",
    "Plane":
        "平面",
    "Number of the symmetry plane, the best one first":
        "在模型自身镜像对称的平面中，从最佳的开始",
    "Move the border of the part to the creases nearby, as far as the inside of the model allows":
        "在内部允许的范围内，将部件的边界移到附近的折痕",
    "Close the part with a smooth surface instead of flat facets":
        "用平滑的表面封闭部件，而不是内部与其余部分分隔的平面",
    "Copy Part as Solid":
        "将部件复制为实体",
    "Copy the picked part as a solid: a new object, closed where it was cut; Ctrl C, Ctrl V take it to other files":
        "将选取的部件复制为实体：一个在切口处封闭的新物体；Ctrl C、Ctrl V 可带到其他文件",
    "Remove Part":
        "移除部件",
    "Remove the picked part from the mesh and close the hole":
        "从网格中取出选取的部件并封闭孔洞",
    "Split into Solids":
        "分割为实体",
    "Make each part of a cut a separate object: closed solids that fit each other exactly":
        "将划分的每个部件设为单独的物体：彼此精确相符的封闭实体",
    "By":
        "依据",
    "What decides where to cut":
        "决定切割位置的依据",
    "Number of parts; the last merges are undone":
        "分成这么多部件，即最后合并的那些",
    "Number of parts; as nearly convex as possible in total":
        "分成这么多部件，即总体最接近凸的那些",
    "Height":
        "高度",
    "Into the largest parts of at most this concavity":
        "分成凹度不超过此值的最大部件",
    "How many parts":
        "部件数量",
    "Largest concavity of a part: the volume between it and its convex hull":
        "部件的最大凹度：部件与其凸壳之间的体积",
    "Distance by which the parts move apart, times their distance from the center":
        "按与中心的距离将部件移开的程度",
    "Hide the object that was split":
        "隐藏被分割的物体",
    "This part has no faces of the mesh. Choose a larger one.":
        "该部件没有网格的面。请取更大的部件。",
    "This part can't be closed: its border crosses itself. Choose a larger or smaller one.":
        "该部件无法封闭：其边界自相交。请取更大或更小的部件。",
    "Face Set from Part by Wheel":
        "由滚轮部件创建面组",
    "Mask from Part by Wheel":
        "由滚轮部件创建遮罩",
    "Vertex Group from Part by Wheel":
        "由滚轮部件创建顶点组",
    "Paint Mask from Part by Wheel":
        "由滚轮部件创建绘制遮罩",
    "Parts as Solids":
        "部件作为实体",
    "Deform":
        "变形",
    "Drag a Handle":
        "拖动手柄",
    "Turn at the Joint":
        "在关节处旋转",
    "Within the part, proportionally:":
        "在部件内，按比例：",
    "No parts yet":
        "还没有部件",
    "Parts are stored in the file":
        "部件来自文件",
    "Vertices have moved since: you can recompute the parts":
        "顶点已移动：可以重新计算部件",
    "The mesh has changed: the next use finds its parts again":
        "网格已更改：下次使用时重新查找部件",
    "From the mesh as it is":
        "来自原网格",
    "Repaired copy, {off} off":
        "修复的副本，偏差 {off}",
    "Points on it, {off} off":
        "表面上的点，偏差 {off}",
    "Coarser copy, {off} off":
        "较粗的副本，偏差 {off}",
    "Partwheel":
        "Partwheel",
    "Find at Full Resolution":
        "精确查找",
    "Recompute":
        "重新计算",
    "Part: {share} of the area":
        "部件：占面积 {share}",
    "Parts of {count:,} faces":
        "{count:,} 个面的部件",
    "Part (Segment, Region, Island)":
        "部件（分段、区域、孤岛）",
    "Path of the Part":
        "部件的路径",
    "Show the parts that the wheel goes through, from the smallest to the whole; click one to select it":
        "显示滚轮经过的部件，从最小到整体，点击即可选取",
    "Remembered Parts":
        "记住的部件",
    "{operator} stopped: the mesh or its mode has changed.":
        "{operator} 已停止：网格的编辑状态已改变。",
    "{operator}: start this with the mouse over a 3D view.":
        "{operator}：请将鼠标置于 3D 视图上再启动。",
    "Partwheel stopped: {reason}. The full report is in the system console.":
        "Partwheel 已停止：{reason}。完整报告见系统控制台。",
    "Wheel, ↑↓":
        "滚轮、↑↓",
    "Confirm":
        "确认",
    "Cancel":
        "取消",
    "Pick a Part":
        "选取部件",
    "Snap":
        "吸附",
    "Number":
        "编号",
    "Navigate":
        "导航",
    "Drag":
        "拖动",
    "Within":
        "内部",
    "Similar":
        "相似",
    "Copy":
        "复制",
    "Remove":
        "移除",
    "More, Fewer":
        "更多、更少",
    "Drag or Place the Handle":
        "拖动手柄，或放到其他位置",
    "One More":
        "再加一个",
    "Move, Rotate, Scale":
        "移动、旋转、缩放",
    "Handle Size":
        "手柄大小",
    "Wheel":
        "滚轮",
    "Confirm, Recompute Parts":
        "确认并重新计算部件",
    "Axis":
        "轴",
    "Type":
        "输入",
    "Precise":
        "精确",
    "Done":
        "完成",
    "Shift Wheel":
        "Shift 滚轮",
    "Page Up/Down":
        "Page Up/Down",
    "Next, Previous Part":
        "下一个、上一个部件",
    "Ctrl Wheel":
        "Ctrl 滚轮",
    "Swap":
        "交换",
    "A Part":
        "单个部件",
    "Merge":
        "合并",
    "Join, Split":
        "合并、拆分",
    "Automatic":
        "自动",
    "Groups":
        "组",
    "Colors":
        "颜色",
    "Slots":
        "槽",
    "Print":
        "打印",
    "Another":
        "其他",
    # Of the library
    "This part is no solid: it has no face of the surface. Take a larger one.":
        "该部件不是实体：它没有表面上的面。请取更大的部件。",
    "The part has no faces: pick one that has some.":
        "该部件没有面：请选取有面的部件。",
    "There are no triangles: select a part with faces.":
        "没有三角形：请选择有面的部件。",
    "The part's faces are too thin to be deformed. Dissolve degenerate faces or merge vertices by distance first.":
        "该部件的面过于细薄，无法变形。请先融并简并面，或按间距合并顶点。",
    "The mesh has no area at all: only edges and points.":
        "网格没有面积：只有边和点。",
    "The mesh is a sheet, not a solid: it is open, and closing it would take as much new surface as there is. Give it a thickness (Solidify), close it, or allow open surfaces, which are then taken as thin solids.":
        "网格是薄片而非实体：它是开放的，封闭它需要与现有同样多的新表面。请加厚（实体化）、封闭，或允许开放表面，将其视为薄实体。",
    "The surface encloses no volume. Give it some thickness.":
        "表面未包围任何体积。请赋予一定厚度。",
    "There is not enough memory to fill this mesh. Decimate it first.":
        "内存不足，无法填充此网格。请先精简。",
    "The mesh can't be filled: some faces are too close together to be told apart. Merge vertices by distance, or move the parts that almost touch further apart.":
        "无法填充网格：某些面过于接近，无法区分。请按间距合并顶点，或将几乎接触的部分移开。",
    "The mesher moved or merged vertices of the surface, for some are too close together. Merge vertices by distance.":
        "某些顶点过于接近，填充时被移动或合并。请按间距合并顶点。",
    "The mesher lost a part of the surface. Remesh or smooth the mesh a little and try again.":
        "填充时丢失了部分表面。请重构网格或稍作平滑后重试。",
    "The mesh has no faces. Choose a mesh object that has some.":
        "网格没有面。请选择有面的网格物体。",
    "All vertices are at the same place. Choose a mesh that has an extent.":
        "所有顶点都在同一位置。请选择有范围的网格。",
    "The mesh has no part that can be closed. Give it a thickness (Solidify).":
        "网格没有可以封闭的部分。请加厚（实体化）。",
    "The surface passes through itself in ways that can't be repaired. Remesh it, or unite its parts with a Boolean.":
        "表面以无法修复的方式自相交。请重构网格，或用布尔运算合并其各部分。",
    "The mesh can't be filled: the mesher comes to no end. Remesh or smooth it a little and try again.":
        "无法填充网格：填充过程不会结束。请重构网格或稍作平滑后重试。",
    "The mesh was not changed.":
        "其他一切完好；网格保持原样。",
    "The build was not done after {seconds} seconds of work and was stopped.":
        "查找运行 {seconds} 秒后仍未完成，已被停止。",
    "The build was not done after {seconds} seconds without any work and was stopped.":
        "查找在 {seconds} 秒内没有任何进展，已被停止。",
    "A mesh with fewer faces (Decimate, or a voxel remesh) is faster.":
        "面数较少的网格（精简或体素重构网格）会更快。",
    "The worker process ran out of memory.":
        "工作进程内存不足。",
    "It may use {size:.1f} GiB.":
        "它最多可使用 {size:.1f} GiB。",
    "A mesh with fewer faces (Decimate, or a voxel remesh) needs less.":
        "面数较少的网格（精简或体素重构网格）需要更少。",
    "Create convex hulls that fit tightly around the model, as children of it, for collisions in game engines":
        "生成少量凸壳，它们包含模型且几乎不多出什么：作为模型的子级，供引擎用作碰撞体",
    "Convex Parts":
        "凸部件",
    "What decides how many hulls there are":
        "由什么决定凸壳的数量",
    "Number of hulls; fewer if more would not improve the fit":
        "这么多凸壳；再多也无益处时则更少",
    "Error":
        "误差",
    "As few hulls as possible within this distance from the model":
        "在任何地方都不超出此距离的、能找到的最少凸壳",
    "Hulls":
        "凸壳",
    "How many":
        "多少",
    "Largest distance of the hulls from the model, relative to the size of the model":
        "凸壳可离模型多远：占模型对角线的比例",
    "Vertices":
        "顶点",
    "Most vertices of a hull: physics engines accept 64 or 255":
        "每个凸壳的上限：物理引擎接受64或255个",
    "For":
        "用于",
    "How the hulls are named, or what they become":
        "凸壳如何命名，或变成什么",
    "Unreal":
        "Unreal",
    "Godot":
        "Godot",
    "Unity":
        "Unity",
    "Names that start with UCX: the importer uses them as the model's collision":
        "以UCX开头的名称：其导入器将它们当作模型的碰撞体",
    "Names that end with -convcolonly: the importer creates bodies with these shapes":
        "以-convcolonly结尾的名称：其导入器将它们变成带形状的物体",
    "Names with collider, for children that get a convex Mesh Collider":
        "含collider的名称，供在那里添加凸面Mesh Collider的子级使用",
    "Rigid Body":
        "刚体",
    "Blender's rigid body: the model falls and rolls with the hulls as its shape":
        "Blender自带：模型会下落和滚动，凸壳就是它的形状",
    "{name} is linked from another file and can't be a rigid body: make it local first (Object > Relations > Make Local).":
        "{name} 是从其他文件链接的，不能成为刚体：请先将其设为本地（物体 > 关系 > 设为本地）。",
    "The name of {name} is too long for the names of its hulls: shorten it.":
        "{name} 的名称太长，无法据此为凸壳命名：请缩短。",
    "Another object has the name {name}, which a hull needs: rename that object.":
        "已有另一个物体名为 {name}，与凸壳要用的名称相同：请将其重命名。",
    "{count} convex hulls around {name} with {times:.2f} times its volume.":
        "围绕 {name} 的 {count} 个凸壳，总体积为其 {times:.2f} 倍。",
    "Count":
        "数量",
    "Primitives":
        "基本体",
    "Replace a hull by a box, sphere, capsule or cylinder within this distance from it, relative as for Error; 0: hulls only":
        "在离凸壳不超过此距离时改用长方体、球、胶囊或圆柱，比例与误差相同；0：只用凸壳",
    "The worker process {how} before it was done.":
        "工作进程在完成之前{how}。",
    "Merging vertices by distance, or a voxel remesh, often helps.":
        "按距离合并顶点或体素重构网格往往有效。",
    "The worker process gave a damaged answer.":
        "工作进程给出的结果已损坏。",
    "The worker process gave a damaged answer: {reason}":
        "工作进程给出的结果已损坏：{reason}",
    "The worker process returned the parts of another mesh.":
        "工作进程给出的是另一个网格的结果。",
    "There is no Python to run the worker process: {reason}.":
        "没有可运行工作进程的 Python：{reason}。",
    "The worker process could not be started: {reason}.":
        "无法启动工作进程：{reason}。",
    "The worker process did not begin in {seconds} seconds.":
        "工作进程在 {seconds} 秒内没有开始工作。",
    "The worker process {how} before it began.":
        "工作进程在开始之前{how}。",
    "If this happens again, choose a Python 3 to run it: Python in the add-on's preferences, or the argument python.":
        "如果仍然如此，请指定用哪个 Python 3 运行它：插件偏好设置中的 Python，或参数 python。",
    "was killed (SIGKILL, possibly because memory ran out)":
        "被强行终止（SIGKILL，可能是内存不足）",
    "crashed ({reason})":
        "崩溃了（{reason}）",
    "was interrupted (Ctrl-C)":
        "被外部结束（Ctrl C）",
    "ended without an answer (exit code {code})":
        "没有给出结果就结束了（退出代码 {code}）",
    "did not answer in {seconds} seconds":
        "在 {seconds} 秒内没有响应",
    "can't be started ({reason})":
        "无法启动（{reason}）",
    "there is none":
        "一个也没有",
    "Remove the parts of the active mesh, also those saved with the file. The mesh stays as it is":
        "清除活动网格的部件，包括随文件保存的部件。网格保持不变",
    "{name} no longer has a part similar to {part}. Pick the part again, forget the name {part}, and remember the part under this name.":
        "{name} 不再有与 {part} 相似的部件。请重新选取部件，忘记名称 {part}，再以该名称记住部件。",
    "{name} has no remembered part {part}. Pick the part, and name it with Remember Part.":
        "{name} 没有名为 {part} 的已记住部件。请选取该部件，并用“记住部件”命名。",
    "{name} has a Multiresolution modifier, whose details would be lost. Apply the modifier first.":
        "{name} 带有多级精度修改器，其细节会丢失。请先应用该修改器。",
    "{name} has a Multiresolution modifier: the new objects have only its coarsest level. To keep the details, apply the modifier first.":
        "{name} 带有多级精度修改器：新物体只有其最粗的级别。要保留细节，请先应用该修改器。",
    "Duplicate Selection":
        "复制选择项",
    "The mesh is too broken for this. Remesh it and try again.":
        "网格破损过于严重，无法处理。请重构网格后重试。",
    "So many triangles pass through each other that the inside can't be found. Remesh the model, or unite its parts with a Boolean.":
        "相互穿插的三角形过多，无法确定内部。请重构网格，或用布尔合并其部件。",
    "There is not enough memory. Close other programs, or decimate the mesh.":
        "内存不足。请关闭其他程序，或精简网格。",
    "No vertex is free to deform: the handle must be smaller than the part, and connected with it.":
        "没有可变形的顶点：手柄必须小于部件，并与其相连。",
    "The shape keys of {names} are lost; the parts keep their current shape. The shape keys of {target} move only its own surface.":
        "{names} 的形态键会丢失；部件保持当前形状。{target} 的形态键只移动其自身的表面。",
    "The model has {count:,} duplicate faces. The objects contain each of them once.":
        "模型有 {count:,} 个重复的面。各物体中每个面只出现一次。",
    "The volumes of the objects add up to {total:.4g}, but the model's volume is {whole:.4g}, because its surface is broken. Repair the mesh, or turn off Closed.":
        "各物体的体积之和为 {total:.4g}，但模型的体积为 {whole:.4g}，因为其表面有破损。请修复网格，或关闭“封闭”。",
    "Only the mesh of {name} itself is printed, without the effect of its modifiers. To print it, apply them first.":
        "只打印 {name} 的网格本身，不含其修改器的效果。如要打印该效果，请先应用修改器。",
    "How the part follows the handle":
        "部件如何跟随手柄",
    "How the parts change the current selection":
        "部件如何更改当前选择",
    "The part is the whole model, which has no other side. Pick a smaller one.":
        "该部件是整个模型，没有另一侧。请选取更小的部件。",
    "The part is the whole model: nothing would be left without it. Pick a smaller one.":
        "该部件是整个模型：去掉后将一无所剩。请选取更小的部件。",
    "The scene is linked from another file, so no object can be added to it.":
        "场景链接自其他文件，因此无法向其中添加物体。",
    "The modifier {modifier} is bound to the vertices of {name}, which change: bind it again afterwards.":
        "修改器 {modifier} 绑定到 {name} 的顶点，而这些顶点会改变：请之后重新绑定。",
    "The selection must be exactly one whole part. Pick the part again with Select Part by Wheel, and confirm it.":
        "选择必须恰好是一个完整的部件。请用“滚轮选择部件”重新选取部件并确认。",
    "New Part":
        "新部件",
}
