# SPDX-License-Identifier: GPL-3.0-or-later
"""Japanese."""

WORDS = {
    "Turn":
        "回転",
    "About the border's normal":
        "境界の法線を軸とする回転",
    "Depth":
        "深さ",
    "How deep the part sinks in, in radii of its border":
        "境界の半径を単位とした、埋め込む深さ",
    "size {size:.2f}, turn {turn:.0f}°, depth {depth:.2f}":
        "サイズ {size:.2f}、回転 {turn:.0f}°、深さ {depth:.2f}",
    "Place Part":
        "パーツを配置",
    "Place the active part on a surface: it follows the mouse with its border on the surface":
        "アクティブなパーツを面の上に配置します。境界を面に合わせ、面の向きに沿ってマウスについていきます",
    "{operator} stopped: the part is no longer the active object.":
        "{operator} を終了しました。パーツがアクティブオブジェクトではなくなりました。",
    "Onto":
        "配置先",
    "The object that the part is placed on":
        "パーツを配置するオブジェクト",
    "Location":
        "位置",
    "Location of the part's border":
        "境界が置かれる位置",
    "Normal":
        "ノーマル",
    "Normal of the surface at the location":
        "その位置の面の法線",
    "Size":
        "サイズ",
    "Factor of the part's size":
        "元のサイズに対する倍率",
    "Fit Border":
        "境界に合わせる",
    "Fit the part to the target's nearest border, where a part was removed":
        "パーツが取り除かれた、ターゲットの最も近い境界に、そのサイズで合わせます",
    "Mirror Copy":
        "ミラーコピー",
    "Add the mirror image across the target's own X axis":
        "ターゲット自身の X 軸で反転したものを追加します",
    "In Object Mode, make the part that you want to place the active object.":
        "オブジェクトモードで、配置するパーツをアクティブオブジェクトにしてください。",
    "Choose the mesh object to place the part on.":
        "パーツを配置するメッシュオブジェクトを指定してください。",
    "Move the mouse over a surface":
        "マウスを面の上に移動してください",
    "There is no surface under the mouse yet":
        "マウスの下にまだ面がありません",
    "Onto {name}":
        "{name} の上",
    "fitted":
        "境界に合わせ済み",
    "with mirror copy":
        "ミラーコピーあり",
    "{name} has no border to fit: no part was removed from it.":
        "{name} には合わせる境界がありません。パーツが取り除かれていません。",
    "Swap with Compatible Part":
        "合うパーツと交換",
    "Exchange the picked part for one of another object that fits its border; the wheel goes through the candidates":
        "選んだパーツを、境界に合う他のオブジェクトのパーツと交換します。ホイールで候補を切り替えます",
    "{operator} stopped: the object is no longer the active one.":
        "{operator} を終了しました。オブジェクトがアクティブではなくなりました。",
    "From":
        "交換元",
    "The object that the new part comes from; none: the other selected objects, or else all others":
        "新しいパーツの元になるオブジェクト。空の場合は選択中のもの、なければ他のすべて",
    "Part":
        "パーツ",
    "Number of the new part in its object; -1: the most compatible part":
        "そのオブジェクトでの新しいパーツの番号。-1: 最もよく合うもの",
    "Factor of the size at which the borders fit":
        "境界が合うサイズに対する倍率",
    "Mirror":
        "ミラー",
    "Use the part's mirror image":
        "パーツを反転して使います",
    "Blend":
        "ブレンド",
    "Width of a smooth transition on either side of the seam, in radii of the seam":
        "継ぎ目の両側のなめらかな移行部の幅。継ぎ目の半径を単位とします",
    "Find Parts":
        "パーツを検出",
    "Find the parts of the new mesh afterwards, in the background":
        "新しいメッシュのパーツを、別プロセスですぐに検出します",
    "There is no mesh object {name}.":
        "メッシュオブジェクト {name} がありません。",
    "{name}, part {number} of {count}, {likeness:.0%} similar":
        "{name}、パーツ {number} / {count}、類似度 {likeness:.0%}",
    "mirrored":
        "反転",
    "Leave Edit Mode":
        "編集モードを終了",
    "The part is the whole model: nothing would be left to put another part on. Pick a smaller one.":
        "このパーツはモデル全体です。他のパーツを付ける場所が残りません。より小さいパーツを選んでください。",
    "The part has no border with the rest of the model, so no other part can be fitted to it. Pick a part that is connected to the rest.":
        "このパーツにはモデルの残りとの境界がなく、他のパーツを合わせる場所がありません。独立した部品ではなく、モデルから伸びたパーツを選んでください。",
    "No other object has parts. Find the parts of the object that the new part comes from, and select this object, too; or paste a part that was copied as a solid.":
        "他のオブジェクトにパーツがありません。新しいパーツの元になるオブジェクトのパーツを検出し、それも選択してください。または、ソリッドとしてコピーしたパーツを貼り付けてください。",
    "No part there has a border that fits the picked part's.":
        "このパーツの境界に合う境界を持つパーツがありません。",
    "{name} has no part {number}.":
        "{name} にパーツ {number} はありません。",
    "That part of {name} has no border that fits the picked part's.":
        "{name} のそのパーツには、このパーツの境界に合う境界がありません。",
    "{name} has changed and has other parts now. Start again.":
        "{name} が変更され、パーツが変わりました。もう一度始めてください。",
    "it has no faces":
        "面がありません",
    "{count} edges don't have exactly two faces":
        "面がちょうど 2 つではない辺が {count} 個あります",
    "{count} edges have faces of opposite orientation":
        "{count} 個の辺で面の向きが互いに逆です",
    "{count} vertices are loose or connect parts that only touch there":
        "孤立した、または接しているだけの部分をつなぐ頂点が {count} 個あります",
    "{name} is not a solid: {reason}. Repair it, or copy the part again.":
        "{name} はソリッドではありません: {reason}。修復するか、パーツをコピーし直してください。",
    "{name} is not a solid: it is inside out. Turn its faces outside (Recalculate Outside).":
        "{name} はソリッドではありません。裏返しです。面を外側に向けてください (面の向きを外側に揃える)。",
    "by {solver} within: {reason}":
        "{solver} (内部あり): {reason}",
    "by {solver}: {reason}":
        "{solver}: {reason}",
    "{one} and {other} can't be united ({reasons}). Move one of them a little: overlapping coplanar faces are the usual cause.":
        "{one} と {other} は合体できません ({reasons})。どちらかを少し動かしてください。多くの場合、重なり合った面が原因です。",
    "its volume would be {share:.0%} of the sum of both volumes":
        "体積が 2 つの合計の {share:.0%} になります",
    "one of them is missing":
        "片方が抜け落ちました",
    "In Object Mode, select the parts, and then the mesh object to unite them with.":
        "オブジェクトモードで、パーツを選択してから、それらを合体させるメッシュオブジェクトを選択してください。",
    "Unite Solids":
        "ソリッドを合体",
    "Unite the other selected solids with the active one into a single closed mesh":
        "選択した他のソリッドをアクティブなものと合体し、1 つの閉じたメッシュにします",
    "Width of a smooth transition on either side of each seam, in radii of the seam; 0: the seam stays a crease":
        "各継ぎ目の両側のなめらかな移行部の幅。継ぎ目の半径を単位とします。0: 継ぎ目は折り目のまま",
    "Find the parts of the united mesh afterwards, in the background":
        "合体したメッシュのパーツを、別プロセスですぐに検出します",
    "Keep Parts":
        "パーツを残す",
    "Keep the other objects":
        "他のオブジェクトをそのまま残します",
    "{name} is now one closed mesh with {count:,} faces (solver {solver}).":
        "{name} は {count:,} 面の 1 つの閉じたメッシュになりました (ソルバー {solver})。",
    "The vertex group {name} is locked. Unlock it, or give it another name.":
        "頂点グループ {name} はロックされています。ロックを解除するか、別の名前を付けてください。",
    "Face Sets":
        "面セット",
    "One for each part; they replace the existing ones":
        "パーツごとに 1 つ。既存のものはすべて置き換えます",
    "Vertex Groups":
        "頂点グループ",
    "For an armature: smooth across the borders, with a sum of 1":
        "アーマチュア用。境界でなめらかに減衰し、合計は 1 になります",
    "Colored Materials":
        "色分けマテリアル",
    "A material with a color of its own for each part":
        "パーツごとに固有の色のマテリアル",
    "Material Slots":
        "マテリアルスロット",
    "The model's own materials, with a slot for each part":
        "モデル自身のマテリアルを、パーツごとのスロットに割り当てます",
    "Seams":
        "シーム",
    "For unwrapping: along the borders, in creases, and where a part would not lie flat":
        "展開用。境界、折り目、および平らにならない箇所に沿って付けます",
    "Objects":
        "オブジェクト",
    "Each part becomes an object, parented to its neighbor":
        "各パーツを、隣のパーツを親とするオブジェクトにします",
    "Bones":
        "ボーン",
    "An armature with a bone for each part, and its vertex groups, ready to pose":
        "パーツごとのボーンを持つアーマチュアとその頂点グループ。すぐにポーズを付けられます",
    "For Printing":
        "印刷用",
    "Closed objects with flat cuts, pegs and sockets, checked. Needs manifold3d":
        "平らな切断面、ピンと穴を持つ、検査済みの閉じたオブジェクト。manifold3d が必要です",
    "Parts to...":
        "パーツを変換...",
    "Divide the whole model into parts: the wheel changes the number, a click and the wheel one part, a drag merges":
        "モデル全体をパーツに分割します。ホイールで数を、クリックとホイールで 1 つのパーツを変え、ドラッグで統合します",
    "Create":
        "作成",
    "What to create from the parts; none: only save them in the mesh":
        "パーツの変換先。なし: メッシュ内に保持するだけ",
    "Parts":
        "パーツ",
    "Number of parts; 0: the parts saved in the mesh, or the automatic segmentation":
        "パーツの数。0: メッシュに保持されているもの、または人が最も自然に分けるもの",
    "Closed":
        "閉じる",
    "Close the objects where they were cut, so that they are solids that add up to the whole":
        "切断箇所を閉じます。全体を構成するソリッドになります",
    "Smooth Caps":
        "なめらかなふた",
    "Close the objects with a smooth surface instead of flat facets":
        "残りとの間の平らな内部の面ではなく、なめらかな面で閉じます",
    "Cap Material":
        "ふたのマテリアル",
    "Give the caps a material of their own":
        "ふたに固有のマテリアルを割り当てます",
    "Origins at Borders":
        "原点を境界に",
    "Place the origin of each object at the center of its border":
        "各オブジェクトは境界の中心を軸に回転します",
    "Explode":
        "分解",
    "Distance by which the objects move apart, times the distance of their centers. You can change it later in a custom property of the largest object":
        "中心間の距離に対する、引き離す量。最大のオブジェクトにはカスタムプロパティとしても付き、後から変更できます",
    "Shell":
        "シェル",
    "Thickness of the walls, by a modifier; 0: solid":
        "モディファイアーによる壁の厚さ。0: 中身あり",
    "Unwrap":
        "展開",
    "Unwrap the mesh along the seams, into a new UV map if there are others":
        "シームに沿ってメッシュを展開します。他に UV マップがあれば新しい UV マップに展開します",
    "Pegs":
        "ピン",
    "Add a peg and a socket across each cut, where there is room":
        "余裕のある切断面ごとに、ピンと穴を付けます",
    "Clearance (mm)":
        "クリアランス (mm)",
    "The gap around each peg, on all sides":
        "各ピンの周囲のすき間",
    "Wall (mm)":
        "壁 (mm)",
    "Minimum thickness of the walls around a socket; a message reports thinner walls":
        "穴の周囲に残る厚さ。これより薄い壁は通知します",
    "Bed (mm)":
        "ベッド (mm)",
    "Size of the printer's bed: larger parts are split further; 0: no limit":
        "プリンターのベッド。それより大きいパーツはさらに分割します。0: 十分な大きさ",
    "Hide Original":
        "元を隠す",
    "Hide the object that was divided":
        "分割したオブジェクトを隠します",
    "This is for an active mesh object, in Object, Edit or Sculpt Mode.":
        "オブジェクト、編集、またはスカルプトモードのアクティブなメッシュオブジェクトが必要です。",
    "Dynamic topology changes the faces all the time: turn it off first.":
        "ダイナミックトポロジーは常に面を変更します。先にオフにしてください。",
    "These are not parts of {name}: {reason}":
        "{name} のパーツではありません: {reason}",
    "{name} now has {count} parts: {results}.":
        "{name} は {count} 個のパーツになりました: {results}。",
    "{count} parts: {results}":
        "{count} パーツ: {results}",
    "{count} parts, one of {faces:,} faces: {results}":
        "{count} パーツ、うち 1 つは {faces:,} 面: {results}",
    "Saved in the Mesh":
        "メッシュに保持",
    "Printing needs the Python package manifold3d, which Blender doesn't have. To install it, run: {python} -m pip install manifold3d.":
        "印刷には Python パッケージ manifold3d が必要ですが、Blender には含まれていません。インストールするには次を実行してください: {python} -m pip install manifold3d。",
    "The scale of {name} is not uniform: apply its scale first.":
        "{name} は軸ごとにスケールが異なります。先にスケールを適用してください。",
    "{name} has {count} UV maps, the most that Blender allows: remove one.":
        "{name} には UV マップが {count} 個あり、これ以上作れません。1 つ削除してください。",
    "Handle of one vertex":
        "1 頂点のハンドル",
    "Handle of {count:,} vertices":
        "{count:,} 頂点のハンドル",
    "The whole part":
        "パーツ全体",
    "Joint of {reach:.1f} radii":
        "半径 {reach:.1f} 倍の関節",
    "The handle covers the whole part, so nothing is left to follow it: make the handle smaller.":
        "ハンドルがパーツ全体を占め、追従する部分がありません。ハンドルを小さくしてください。",
    "One handle covers another: make it smaller or move it.":
        "ハンドル同士が重なっています。小さくするか、別の場所に置いてください。",
    "No visible part of this limb is beyond its joint: make the joint smaller.":
        "この部分には、関節の先に見えている頂点がありません。関節を小さくしてください。",
    "Move":
        "移動",
    "Rotate":
        "回転",
    "Scale":
        "スケール",
    "{movement} along local {axes}":
        "{movement} ローカル {axes} 軸",
    "{movement} along global {axes}":
        "{movement} グローバル {axes} 軸",
    "{movement} in local {axes}":
        "{movement} ローカル {axes} 平面",
    "{movement} in global {axes}":
        "{movement} グローバル {axes} 平面",
    "Vertex":
        "頂点",
    "Radius":
        "半径",
    "Matrix":
        "行列",
    "Deform Part":
        "パーツを変形",
    "Drag a handle of the last picked part: the part follows like a soft body, and the rest of the mesh stays in place":
        "最後に選んだパーツのハンドルをドラッグします。パーツは柔らかい物体のように追従し、その外側は動きません",
    "Number of the part; -1: the last pick":
        "パーツの番号。-1: 最後に選んだパーツ",
    "Method":
        "方式",
    "As Rigid as Possible":
        "できるだけ剛体的に",
    "The part follows the handle and keeps its details":
        "パーツはディテールを保ったままハンドルに追従します",
    "Proportional":
        "プロポーショナル",
    "The part moves as a whole, less toward its border":
        "パーツ全体が動き、境界に近いほど動きが小さくなります",
    "At the Joint":
        "関節で",
    "The part keeps its shape and turns at its border; the mesh near the border bends":
        "パーツは形を保ったまま境界を中心に回転し、境界の両側の近くが曲がります",
    "Rings":
        "リング",
    "Rings of faces around the part that deform with it, for a softer transition":
        "パーツの周囲で一緒に変形する面のリングの数。つながりがなめらかになります",
    "Joint":
        "関節",
    "Distance from the border within which the mesh bends, in radii of the border":
        "パーツの境界からどこまで曲がるか。境界の半径を単位とします",
    "Snap Border":
        "境界をスナップ",
    "Deform the part up to the creases near its border instead of its own border; on for picks with a snapped border":
        "パーツ自身の境界ではなく、近くの折り目まで変形します。そのように選ばれたパーツと同じです",
    "Deform parts in Edit Mode of a mesh.":
        "パーツの変形はメッシュの編集モードで行います。",
    "There is no handle: drag one in the 3D view.":
        "ハンドルがありません。3D ビューでドラッグしてください。",
    "The mesh doesn't have the vertex of a handle.":
        "ハンドルの頂点がメッシュにありません。",
    "{state}: settling":
        "{state}: 収束中",
    "{state}: getting ready":
        "{state}: 準備中",
    "Move Part Proportionally":
        "パーツをプロポーショナル移動",
    "Move the last picked part; its surroundings follow, depending on its size. R rotates and S scales it":
        "最後に選んだパーツを移動します。周囲はその大きさに応じて追従します。R で回転、S でスケールします",
    "The part has no visible vertex inside its border: pick a larger one.":
        "パーツの境界の内側に、見えている頂点がありません。より大きいパーツを選んでください。",
    "The part is the whole mesh or a loose piece, without a border that would stay fixed: pick a smaller one, or move it with Blender's own tools.":
        "パーツがメッシュ全体か独立した部分で、固定する境界がありません。より小さいパーツを選ぶか、そのまま移動してください。",
    "The faces of the part have no area: there is nothing to deform.":
        "パーツの面に面積がなく、変形できません。",
    "This point is not on the part.":
        "そこはパーツの点ではありません。",
    "The mesh of {name} is linked from another file: make it local first (Object > Relations > Make Local).":
        "{name} のメッシュは他のファイルからリンクされています。先にローカル化してください (オブジェクト > 関係 > ローカル化)。",
    "The mesh of {name} is a library override, which Blender does not edit: make it local first (Object > Relations > Make Local).":
        "{name} のメッシュは Blender が編集しないライブラリオーバーライドです。先にローカル化してください (オブジェクト > 関係 > ローカル化)。",
    "This is for an active mesh object, in Edit Mode or Object Mode.":
        "編集モードまたはオブジェクトモードのアクティブなメッシュオブジェクトが必要です。",
    "The build was canceled.":
        "検出をキャンセルしました。",
    "The mesh {name} was deleted, so its parts were discarded.":
        "メッシュ {name} がなくなったため、パーツを破棄しました。",
    "{name} was edited while its parts were being found, so they were discarded. Find them again after editing.":
        "パーツの検出中に {name} が編集されたため、パーツを破棄しました。メッシュが完成したら、もう一度検出してください。",
    "The selection is not a part. Pick one with Select Part by Wheel, and confirm it.":
        "選択部分はパーツではありません。「ホイールでパーツを選択」で選び、確定してください。",
    "No part is picked. Pick one with Select Part by Wheel, and confirm it.":
        "パーツが選ばれていません。「ホイールでパーツを選択」で選び、確定してください。",
    "There is no part {number}: there are {count}.":
        "パーツ {number} はありません。全部で {count} 個です。",
    "{name} has no parts for its current mesh. Find them first.":
        "{name} には現在のメッシュのパーツがありません。先に検出してください。",
    "The parts saved with {name} come from a newer version of Partwheel, so they are found again. Update Partwheel to use the saved parts.":
        "{name} と共に保存されたパーツは、より新しい Partwheel のものなので、検出し直します。ファイルのパーツを使うには Partwheel を更新してください。",
    "Partwheel finds the parts of {name} after those of {other}":
        "Partwheel は {other} の後に {name} のパーツを検出します",
    "Partwheel finds the parts of {name}: {fraction:.0%}":
        "Partwheel が {name} のパーツを検出中: {fraction:.0%}",
    "Esc: Cancel":
        "Esc: キャンセル",
    "Canceled: no parts were found.":
        "キャンセルしました。パーツは検出されませんでした。",
    "To do so, use the panel Partwheel in the sidebar.":
        "サイドバーの Partwheel パネルで行えます。",
    "No parts for {name}: {reason}":
        "{name} のパーツはありません: {reason}",
    "A method that was tried first failed: {reason}":
        "最初に試した方法は失敗しました: {reason}",
    "{name}, {count:,} faces: its parts were found in {seconds:.1f} s.":
        "{name}、{count:,} 面: パーツを {seconds:.1f} 秒で検出しました。",
    "Quality":
        "品質",
    "0 is fastest and right for nearly all meshes. From 1.1 on, the inside is divided more evenly (1.4 is usual, smaller is slower)":
        "0 が最も速く、ほとんどの場合に適しています。1.1 以上では内部をより均等に分割します (通常は 1.4、小さいほど遅い)",
    "Exactly":
        "正確に",
    "Find the parts of a mesh with more than 200,000 triangles at full resolution, not on a coarser copy. Takes about ten times the time and memory. The add-on's preferences can set this for all meshes":
        "20 万三角形を超えるメッシュのパーツを、粗いコピーではなくすべての三角形から検出します。時間とメモリは約 10 倍です。アドオンの設定ですべてに適用できます",
    "Find Parts of Mesh":
        "メッシュのパーツを検出",
    "Find the parts of the active mesh, and of other selected ones that have none, at all sizes for the wheel":
        "アクティブなメッシュと、パーツのない他の選択メッシュのパーツを、ホイール用にあらゆる大きさで検出します",
    "Find the parts of a mesh that another operator has just created; that operator stays the last operation, with its panel":
        "メッシュを作成したオペレーターに代わって同じことを行います。そのオペレーターが最後の操作として残ります",
    "Clear Parts":
        "パーツをクリア",
    "The active object has no parts.":
        "アクティブオブジェクトにパーツがありません。",
    "Part under the Mouse":
        "マウスの下のパーツ",
    "Face Set":
        "面セット",
    "Mask":
        "マスク",
    "Vertex Group":
        "頂点グループ",
    "Paint Mask":
        "ペイントマスク",
    "Part by Wheel":
        "ホイールでパーツ",
    "Pick a part with a click and the mouse wheel, and make it a face set, a mask or a vertex group":
        "クリックとホイールでパーツを選び、面セット、マスク、または頂点グループにします",
    "What the part becomes":
        "パーツの変換先",
    "A new face set":
        "新しい面セット",
    "Masked against sculpting":
        "スカルプトから保護します",
    "Weight 1 in a new vertex group named after the part; Extend adds it to the active group, Deselect removes it from there":
        "パーツにちなんだ名前の新しい頂点グループでウェイト 1。拡張ではアクティブなグループに追加、選択解除ではそこから除外します",
    "The only faces that can be painted on":
        "ペイントできる面をこれだけにします",
    "This is for Sculpt Mode and the paint modes of a mesh.":
        "メッシュのスカルプトモードまたはペイントモードが必要です。",
    "In this mode, parts can't become this: {results}.":
        "このモードではパーツをこれに変換できません: {results}。",
    "Face":
        "面",
    "The face that was clicked":
        "クリックした面",
    "Level":
        "レベル",
    "Notches of the wheel from the part that the click selects; up is positive":
        "クリックだけで選ばれるパーツからのホイールの段数。上が正",
    "Extend":
        "拡張",
    "Add the part to the selection instead of replacing it":
        "選択を置き換えず、パーツを追加します",
    "Deselect":
        "選択解除",
    "Remove the part from the selection":
        "選択からパーツを除外します",
    "Move the border of the part into nearby creases":
        "パーツの境界を近くの折り目に移動します",
    "Face {number} can't be picked: {reason}":
        "面 {number} は選べません: {reason}",
    "This 3D view does not show the mesh that is being edited.":
        "この 3D ビューには編集中のメッシュが表示されていません。",
    "Click a face of the mesh":
        "メッシュの面をクリックしてください",
    "The face there was generated by the modifiers of {name} and belongs to no face of its mesh.":
        "そこに見えているものは {name} のモディファイアーが作ったもので、メッシュのどの面にも属しません。",
    "The parts are found. Start {operator} again to pick them.":
        "パーツを検出しました。選ぶには {operator} をもう一度開始してください。",
    "Partwheel stopped: the parts were found again. Pick one of them.":
        "Partwheel を終了しました。パーツが検出し直されました。その中から選んでください。",
    "There is no face there":
        "そこには面がありません",
    "Part {number} of {count}, {faces:,} faces, {share} of the area":
        "パーツ {number} / {count}、{faces:,} 面、面積の {share}",
    "border in creases":
        "折り目に沿った境界",
    "Select Part by Wheel":
        "ホイールでパーツを選択",
    "Pick a part of the mesh with a click, then make it larger or smaller with the mouse wheel":
        "クリックでメッシュのパーツを選び、マウスホイールで大きくしたり小さくしたりします",
    "Select parts in Edit Mode of a mesh.":
        "パーツの選択はメッシュの編集モードで行います。",
    "Pick a part of the mesh under the mouse in Object Mode, then enter Edit Mode with the part selected":
        "マウスの下のメッシュのパーツを選び (その間メッシュは変わりません)、そのパーツで編集モードに入ります",
    "This is for Object Mode.":
        "オブジェクトモードが必要です。",
    "There is no mesh under the mouse.":
        "マウスの下にメッシュがありません。",
    "{name} is an instance, and this 3D view does not show its original: edit it there.":
        "{name} はインスタンスで、この 3D ビューには元のオブジェクトが表示されていません。元のほうで編集してください。",
    "Toggle Edit Mode":
        "編集モード切替え",
    "Select Part":
        "パーツを選択",
    "Select a meaningful part of the mesh.\nClick a part, then turn the wheel for the next larger or smaller one. Shift adds, Ctrl removes":
        "メッシュの意味のあるパーツを選択します。\nパーツをクリックし、ホイールで一段大きい、または小さいパーツに切り替えます。Shift で追加、Ctrl で除外",
    "Parts are found at the first click":
        "パーツは最初のクリックで検出されます",
    "Pick a meaningful part of a mesh.\nClick a part, then turn the wheel for the next larger or smaller one. Shift adds, Ctrl removes":
        "メッシュの意味のあるパーツを選び取ります。\nパーツをクリックし、ホイールで一段大きい、または小さいパーツに切り替えます。Shift で追加、Ctrl で除外",
    "Mask a meaningful part of the mesh, or make it a face set.\nClick a part, then turn the wheel for the next larger or smaller one. Shift adds, Ctrl removes":
        "メッシュの意味のあるパーツをマスクするか、面セットにします。\nパーツをクリックし、ホイールで一段大きい、または小さいパーツに切り替えます。Shift で追加、Ctrl で除外",
    "Make a meaningful part of the mesh a vertex group.\nClick a part, then turn the wheel for the next larger or smaller one. Shift adds, Ctrl removes":
        "メッシュの意味のあるパーツを頂点グループにします。\nパーツをクリックし、ホイールで一段大きい、または小さいパーツに切り替えます。Shift で追加、Ctrl で除外",
    "Paint only on a meaningful part of the mesh.\nClick a part, then turn the wheel for the next larger or smaller one. Shift adds, Ctrl removes":
        "メッシュの意味のあるパーツだけにペイントします。\nパーツをクリックし、ホイールで一段大きい、または小さいパーツに切り替えます。Shift で追加、Ctrl で除外",
    "Select all parts that a box touches, at the level of the last pick.\nShift adds, Ctrl removes. A click picks a part as with Select Part":
        "矩形が触れるすべてのパーツを、最後に選んだパーツと同じ段数で選択します。\nShift で追加、Ctrl で除外。クリックすると「パーツを選択」と同じようにパーツを選びます",
    "Select all parts that a lasso touches, at the level of the last pick.\nShift adds, Ctrl removes. A click picks a part as with Select Part":
        "投げ縄が触れるすべてのパーツを、最後に選んだパーツと同じ段数で選択します。\nShift で追加、Ctrl で除外。クリックすると「パーツを選択」と同じようにパーツを選びます",
    "Select all parts (segments, regions) that a box touches, at the level of the last pick":
        "矩形が触れるすべてのパーツ（セグメント、領域）を、最後に選んだパーツと同じ段数で選択します",
    "Select all parts (segments, regions) that a lasso touches, at the level of the last pick":
        "投げ縄が触れるすべてのパーツ（セグメント、領域）を、最後に選んだパーツと同じ段数で選択します",
    "Select Parts by Box":
        "矩形でパーツを選択",
    "Select Parts by Lasso":
        "投げ縄でパーツを選択",
    "Select the whole parts that a gesture touched":
        "ジェスチャーで選択したものを、触れたパーツ全体にします",
    "Mode":
        "モード",
    "Set":
        "設定",
    "Select these parts and nothing else":
        "これらのパーツだけを選択します",
    "Add these parts to the selection":
        "選択に追加します",
    "Subtract":
        "減算",
    "Remove these parts from the selection":
        "選択から除外します",
    "Parts: Store Selection":
        "パーツ：選択中のもの",
    "Whole Parts":
        "パーツ全体",
    "Store the current selection":
        "選択中のものを記憶します",
    "Pick Part by Wheel":
        "ホイールでパーツを選び取る",
    "Pick a part of the mesh under the mouse to copy, swap or divide it; it is also selected in Edit Mode":
        "マウスの下のメッシュのパーツを選び取り、コピー、交換、分割に使います。編集モードでは選択されています",
    "A mask in Sculpt Mode, a vertex group in Weight Paint, else a paint mask":
        "スカルプトモードではマスク、ウェイトペイントでは頂点グループ、それ以外はペイントマスク",
    "When the wheel resizes the part, after a click with the tool":
        "ツールでクリックした後、いつホイールでパーツを拡大・縮小するか",
    "At the Click":
        "クリック位置",
    "While the mouse stays at the click; elsewhere the wheel zooms as usual":
        "マウスがクリックした場所にある間。それ以外では通常どおりズームします",
    "Until Enter":
        "Enter まで",
    "Wherever the mouse is, until Enter or another key ends it":
        "マウスの位置にかかわらず、Enter などのキーで終了するまで",
    "Buttons":
        "ボタン",
    "Show two buttons beside the click, larger and smaller. With a pen they are always shown":
        "クリックの横に拡大と縮小の2つのボタンを表示します。ペンでは常に表示されます",
    "Blender would not undo a mask of the multires modifier's levels. Make the part a face set instead: the tool's header and the menu Face Sets have it.":
        "マルチレゾモディファイアーのレベルのマスクは、Blender では元に戻せません。代わりにパーツを面セットにしてください。ツールのヘッダーと面セットメニューにあります。",
    "Overlay":
        "オーバーレイ",
    "The vertex group {name} is locked. Unlock it, or pick the part alone: it gets a group of its own.":
        "頂点グループ {name} はロックされています。ロックを解除するか、パーツだけを選んでください。専用のグループになります。",
    "{name} has no vertex group that the part could be removed from.":
        "{name} には、パーツを除外できる頂点グループがありません。",
    "The part was removed from the vertex group {name}.":
        "パーツを頂点グループ {name} から除外しました。",
    "The part was added to the vertex group {name}.":
        "パーツを頂点グループ {name} に追加しました。",
    "The part is the new vertex group {name}.":
        "パーツは新しい頂点グループ {name} になりました。",
    "Find on Import":
        "インポート時に検出",
    "Find the parts of imported and appended meshes at once, while you keep working":
        "インポートまたはアペンドしたもののパーツを、作業を続けている間にすぐ検出します",
    "Find Parts of Imported Meshes":
        "インポートしたメッシュのパーツを検出",
    "Find the parts of newly imported meshes":
        "パーツのない選択メッシュのパーツを、それを読み込んだインポートのために検出します",
    "Select meshes without parts, in Object Mode.":
        "これはオブジェクトモードで選択した、パーツのないメッシュのためのものです。",
    "Save Parts in .blend Files":
        "パーツを .blend ファイルに保存",
    "Save the parts of meshes with the file, so that they need not be found again. The file grows by about 40 bytes per face":
        "検出したパーツを、ファイルを開いたときに復元します。1 面あたり約 40 バイト増えます",
    "How the next builds merge small parts into larger ones":
        "今後の検出で、小さいパーツを大きいパーツにまとめる方法",
    "As People See Them":
        "人が見るように",
    "Learned from the parts that people chose on some hundred models: a click alone finds the intended part more often. Borders follow creases, and symmetric models get symmetric parts":
        "数百のモデルで人がパーツとみなしたものに基づきます。クリックだけで意図したパーツが見つかりやすくなります。境界は折り目に沿い、左右対称なモデルの両側は同じになります",
    "Nearly Convex":
        "ほぼ凸",
    "By convexity alone, the most regular and fastest method: a click selects the smallest part, and each notch of the wheel takes one step":
        "凸性だけに基づく、最も規則的で速い方法。クリックで最小の部分を選び、ホイールの 1 段ごとに一歩進みます",
    "Large Meshes at Full Resolution":
        "大きいメッシュも正確に",
    "Find the parts of meshes with more than 200,000 triangles at full resolution, not on a coarser copy. Takes about ten times the time and memory, for mostly the same parts":
        "20 万三角形を超えるメッシュのパーツを、粗いコピーではなくすべての三角形から検出します。時間とメモリは約 10 倍で、パーツはほとんど同じです",
    "Memory":
        "メモリ",
    "Share of the available memory that a build may use (enforced on Linux)":
        "使用可能なメモリのうち検出に使う割合 (Linux で有効)",
    "Time Limit":
        "制限時間",
    "Minutes of processor time after which a build is stopped. 0: two, plus two for each 60,000 triangles, far more than builds need":
        "検出を停止するまでのプロセッサー時間 (分)。0: 2 分と、6 万三角形ごとにさらに 2 分。実際よりはるかに長い時間です",
    "Python":
        "Python",
    "The Python 3 program that runs builds in a separate process. Empty: the one in Blender, or else an installed one":
        "別プロセスでパーツを検出するプログラム (Python 3)。空: Blender 付属のもの、なければインストール済みのもの",
    "Tint the picked part":
        "保持中のパーツに色を付けます",
    "Next Part":
        "次のパーツ",
    "Tint faintly what the next notch of the wheel adds":
        "ホイールの次の段で加わる部分に薄く色を付けます",
    "Convex Hull":
        "凸包",
    "Show the convex hull of the picked part as glass":
        "保持中のパーツの凸包をガラスのように表示します",
    "All Parts":
        "すべてのパーツ",
    "Show all parts of the mesh at the size of the picked part, each in its own color":
        "メッシュ全体のパーツを、保持中のパーツの大きさで色分け表示します",
    "Pie Menu":
        "パイメニュー",
    "The part has no mirror image in {name}: it crosses the symmetry plane, or the model is not symmetric.":
        "パーツの鏡像が {name} にありません。対称面にまたがっているか、モデルの両側が同じではありません。",
    "Remember parts in Edit Mode of a mesh.":
        "パーツの記憶はメッシュの編集モードで行います。",
    "Name of the remembered part":
        "記憶されている名前",
    "Remember Part":
        "パーツを記憶",
    "Name the last picked part (segment, region), so that you can select it again from the panel's list":
        "最後に選んだパーツ (セグメント、領域) に名前を付けます。パネルのリストからその名前で再び選択できます",
    "Name":
        "名前",
    "The part's name":
        "パーツの名前",
    "Part {number}":
        "パーツ {number}",
    "Select Remembered Part":
        "記憶したパーツを選択",
    "Select the remembered part. Shift adds it to the selection, Ctrl removes it":
        "この名前で記憶したパーツを選択します。Shift で選択に追加、Ctrl で除外",
    "Rename Part":
        "パーツの名前を変更",
    "Rename a remembered part":
        "記憶したパーツに別の名前を付けます",
    "New Name":
        "新しい名前",
    "New name of the part":
        "今後のパーツの名前",
    "Forget Part":
        "パーツを忘れる",
    "Forget a remembered part; the mesh does not change":
        "パーツの名前を忘れます。メッシュは変わりません",
    "Enter a name for the part.":
        "パーツは名前で記憶します。名前は空にできません。",
    "The name {name} is too long: use at most {count} letters, fewer in some scripts.":
        "{name} は名前として長すぎます。{count} 文字まで使えます (文字の種類によってはそれ以下)。",
    "There already is a remembered part {name}. Enter another name, or forget that part first.":
        "{name} として記憶したパーツがすでにあります。別の名前を付けるか、先にそれを忘れてください。",
    "Add to the selection instead of replacing it":
        "選択を置き換えず、追加します",
    "Select Similar Parts":
        "類似パーツを選択",
    "Select all parts (segments, regions) similar to the last pick, in all edited objects: fingers, legs, horns":
        "編集中の各オブジェクトで、最後に選んだパーツと似たすべてのパーツ (セグメント、領域) を選択します。指、脚、角など",
    "Not searched, since they have no parts yet: {names}. Find their parts first.":
        "まだパーツがないため検索していません: {names}。先にパーツを検索してください。",
    "Threshold":
        "しきい値",
    "Minimum similarity of selected parts: 1 is the same shape and size; lower values select more parts":
        "選択するパーツの類似度。1 は同じ形と大きさで、小さいほど多くのパーツを選択します",
    "{count} parts, similarity at least {threshold:.2f}":
        "{count} パーツ、類似度 {threshold:.2f} 以上",
    "Select Mirrored Part":
        "反対側のパーツを選択",
    "Select the part (segment, region) on the other side of the model, across its own plane of symmetry":
        "モデル自身の対称面をはさんで反対側のパーツ (セグメント、領域) を選択します",
    "Plane":
        "平面",
    "Number of the symmetry plane, the best one first":
        "モデルが対称になる平面のうち、最も良いものから順に",
    "Move the border of the part to the creases nearby, as far as the inside of the model allows":
        "パーツの境界を、内部が許す範囲で近くの折り目に移動します",
    "Close the part with a smooth surface instead of flat facets":
        "残りとの間の平らな内部の面ではなく、なめらかな面でパーツを閉じます",
    "Copy Part as Solid":
        "パーツをソリッドとしてコピー",
    "Copy the picked part as a solid: a new object, closed where it was cut; Ctrl C, Ctrl V take it to other files":
        "選んだパーツをソリッドとしてコピーします。切断箇所が閉じた新しいオブジェクトで、Ctrl C、Ctrl V で他のファイルに移せます",
    "Remove Part":
        "パーツを削除",
    "Remove the picked part from the mesh and close the hole":
        "選んだパーツをメッシュから取り除き、穴を閉じます",
    "Split into Solids":
        "ソリッドに分割",
    "Make each part of a cut a separate object: closed solids that fit each other exactly":
        "分割した各パーツを個別のオブジェクトにします。互いに正確に合う閉じたソリッドです",
    "By":
        "基準",
    "What decides where to cut":
        "切断する場所の決め方",
    "Number of parts; the last merges are undone":
        "この数のパーツに分割します。最後に結合されたものから分けます",
    "Number of parts; as nearly convex as possible in total":
        "この数のパーツに分割します。全体として最も凸に近くなるように分けます",
    "Height":
        "高さ",
    "Into the largest parts of at most this concavity":
        "凹みがこの値以下の最大のパーツに分割します",
    "How many parts":
        "パーツの数",
    "Largest concavity of a part: the volume between it and its convex hull":
        "パーツの凹みの最大値。パーツとその凸包の間の体積",
    "Distance by which the parts move apart, times their distance from the center":
        "中心からの距離に対する、パーツを引き離す量",
    "Hide the object that was split":
        "分割したオブジェクトを隠します",
    "This part has no faces of the mesh. Choose a larger one.":
        "このパーツにはメッシュの面がありません。より大きいパーツを選んでください。",
    "This part can't be closed: its border crosses itself. Choose a larger or smaller one.":
        "境界が交差しているため、このパーツは閉じられません。より大きい、または小さいパーツを選んでください。",
    "Face Set from Part by Wheel":
        "ホイールで選んだパーツから面セット",
    "Mask from Part by Wheel":
        "ホイールで選んだパーツからマスク",
    "Vertex Group from Part by Wheel":
        "ホイールで選んだパーツから頂点グループ",
    "Paint Mask from Part by Wheel":
        "ホイールで選んだパーツからペイントマスク",
    "Parts as Solids":
        "ソリッドとしてのパーツ",
    "Deform":
        "変形",
    "Drag a Handle":
        "ハンドルをドラッグ",
    "Turn at the Joint":
        "関節で回転",
    "Within the part, proportionally:":
        "パーツ内でプロポーショナル:",
    "No parts yet":
        "パーツはまだありません",
    "Parts are stored in the file":
        "パーツはファイルに付属しています",
    "Vertices have moved since: you can recompute the parts":
        "頂点が移動しました。パーツを再計算できます",
    "The mesh has changed: the next use finds its parts again":
        "メッシュが変わりました。次の使用時にパーツを検出し直します",
    "From the mesh as it is":
        "元のメッシュから",
    "Repaired copy, {off} off":
        "修復コピー、ずれ {off}",
    "Points on it, {off} off":
        "面上の点、ずれ {off}",
    "Coarser copy, {off} off":
        "粗いコピー、ずれ {off}",
    "Partwheel":
        "Partwheel",
    "Find at Full Resolution":
        "正確に検出",
    "Recompute":
        "再計算",
    "Part: {share} of the area":
        "パーツ: 面積の {share}",
    "Parts of {count:,} faces":
        "{count:,} 面のパーツ",
    "Part (Segment, Region, Island)":
        "パーツ (セグメント、領域、アイランド)",
    "Path of the Part":
        "パーツの経路",
    "Show the parts that the wheel goes through, from the smallest to the whole; click one to select it":
        "ホイールが通るパーツを、最小から全体まで表示します。クリックで選べます",
    "Remembered Parts":
        "記憶したパーツ",
    "{operator} stopped: the mesh or its mode has changed.":
        "{operator} を終了しました。メッシュの編集状態が変わりました。",
    "{operator}: start this with the mouse over a 3D view.":
        "{operator}: マウスを 3D ビューの上に置いて開始してください。",
    "Partwheel stopped: {reason}. The full report is in the system console.":
        "Partwheel を終了しました: {reason}。詳細はシステムコンソールにあります。",
    "Wheel, ↑↓":
        "ホイール、↑↓",
    "Confirm":
        "確定",
    "Cancel":
        "キャンセル",
    "Pick a Part":
        "パーツを選ぶ",
    "Snap":
        "スナップ",
    "Number":
        "番号",
    "Navigate":
        "ナビゲート",
    "Drag":
        "ドラッグ",
    "Within":
        "内部",
    "Similar":
        "類似",
    "Copy":
        "コピー",
    "Remove":
        "削除",
    "More, Fewer":
        "多く、少なく",
    "Drag or Place the Handle":
        "ハンドルをドラッグ、または別の場所に置く",
    "One More":
        "もう 1 つ",
    "Move, Rotate, Scale":
        "移動、回転、スケール",
    "Handle Size":
        "ハンドルのサイズ",
    "Wheel":
        "ホイール",
    "Confirm, Recompute Parts":
        "確定してパーツを再計算",
    "Axis":
        "軸",
    "Type":
        "入力",
    "Precise":
        "精密",
    "Done":
        "完了",
    "Shift Wheel":
        "Shift ホイール",
    "Page Up/Down":
        "Page Up/Down",
    "Next, Previous Part":
        "次、前のパーツ",
    "Ctrl Wheel":
        "Ctrl ホイール",
    "Swap":
        "交換",
    "A Part":
        "パーツ",
    "Merge":
        "統合",
    "Join, Split":
        "結合、分割",
    "Automatic":
        "自動",
    "Groups":
        "グループ",
    "Colors":
        "カラー",
    "Slots":
        "スロット",
    "Print":
        "印刷",
    "Another":
        "別のパーツ",
    # Of the library
    "This part is no solid: it has no face of the surface. Take a larger one.":
        "このパーツはソリッドではありません。表面の面を含みません。より大きいパーツを選んでください。",
    "The part has no faces: pick one that has some.":
        "パーツに面がありません。面のあるパーツを選んでください。",
    "There are no triangles: select a part with faces.":
        "三角形がありません。面のあるパーツを選択してください。",
    "The part's faces are too thin to be deformed. Dissolve degenerate faces or merge vertices by distance first.":
        "パーツの面が細すぎて変形できません。先に縮退した面を溶解するか、頂点を距離でマージしてください。",
    "The mesh has no area at all: only edges and points.":
        "メッシュに面積がありません。辺と点だけです。",
    "The mesh is a sheet, not a solid: it is open, and closing it would take as much new surface as there is. Give it a thickness (Solidify), close it, or allow open surfaces, which are then taken as thin solids.":
        "メッシュはソリッドではなくシートです。開いていて、閉じるには今と同じだけの面が必要です。厚みを付ける (ソリッド化)、閉じる、または開いたサーフェスを許可して薄いソリッドとみなしてください。",
    "The surface encloses no volume. Give it some thickness.":
        "表面が体積を囲んでいません。厚みを付けてください。",
    "There is not enough memory to fill this mesh. Decimate it first.":
        "このメッシュを処理するメモリが足りません。先にデシメートしてください。",
    "The mesh can't be filled: some faces are too close together to be told apart. Merge vertices by distance, or move the parts that almost touch further apart.":
        "一部の面が近すぎて区別できず、メッシュを処理できません。頂点を距離でマージするか、ほぼ接している部分を離してください。",
    "The mesher moved or merged vertices of the surface, for some are too close together. Merge vertices by distance.":
        "近すぎる頂点があり、処理中に移動または結合されました。頂点を距離でマージしてください。",
    "The mesher lost a part of the surface. Remesh or smooth the mesh a little and try again.":
        "処理中に表面の一部が失われました。リメッシュするか、メッシュを少しスムーズにしてもう一度試してください。",
    "The mesh has no faces. Choose a mesh object that has some.":
        "メッシュに面がありません。面のあるメッシュオブジェクトを選んでください。",
    "All vertices are at the same place. Choose a mesh that has an extent.":
        "すべての頂点が同じ位置にあります。広がりのあるメッシュを選んでください。",
    "The mesh has no part that can be closed. Give it a thickness (Solidify).":
        "メッシュに閉じられる部分がありません。厚みを付けてください (ソリッド化)。",
    "The surface passes through itself in ways that can't be repaired. Remesh it, or unite its parts with a Boolean.":
        "表面が修復できない形で自己交差しています。リメッシュするか、ブーリアンで各部分を合体してください。",
    "The mesh can't be filled: the mesher comes to no end. Remesh or smooth it a little and try again.":
        "処理が終わらず、メッシュを処理できません。リメッシュするか、少しスムーズにしてもう一度試してください。",
    "The mesh was not changed.":
        "ほかには何も損なわれておらず、メッシュは元のままです。",
    "The build was not done after {seconds} seconds of work and was stopped.":
        "検索は {seconds} 秒働いても終わらず、止められました。",
    "The build was not done after {seconds} seconds without any work and was stopped.":
        "検索は {seconds} 秒間まったく進まず、止められました。",
    "A mesh with fewer faces (Decimate, or a voxel remesh) is faster.":
        "面の少ないメッシュ（デシメートまたはボクセルリメッシュ）なら速くなります。",
    "The worker process ran out of memory.":
        "作業プロセスのメモリが足りなくなりました。",
    "It may use {size:.1f} GiB.":
        "使えるのは {size:.1f} GiB までです。",
    "A mesh with fewer faces (Decimate, or a voxel remesh) needs less.":
        "面の少ないメッシュ（デシメートまたはボクセルリメッシュ）なら少なくて済みます。",
    "Create convex hulls that fit tightly around the model, as children of it, for collisions in game engines":
        "モデルとわずかな余白だけを含む少数の凸包を作る: モデルの子で、エンジンの衝突判定に使える形",
    "Convex Parts":
        "凸パーツ",
    "What decides how many hulls there are":
        "凸包の数を何で決めるか",
    "Number of hulls; fewer if more would not improve the fit":
        "この数の凸包。増やしても良くならなければ少なくなる",
    "Error":
        "誤差",
    "As few hulls as possible within this distance from the model":
        "モデルからこれ以上離れない、見つかる限り少ない凸包",
    "Hulls":
        "凸包",
    "How many":
        "いくつ",
    "Largest distance of the hulls from the model, relative to the size of the model":
        "凸包がモデルからどれだけ離れてよいか: モデルの対角線に対する割合",
    "Vertices":
        "頂点",
    "Most vertices of a hull: physics engines accept 64 or 255":
        "凸包ごとの上限: 物理エンジンは64または255まで受け付ける",
    "For":
        "用途",
    "How the hulls are named, or what they become":
        "凸包の名前の付け方、または凸包を何にするか",
    "Unreal":
        "Unreal",
    "Godot":
        "Godot",
    "Unity":
        "Unity",
    "Names that start with UCX: the importer uses them as the model's collision":
        "UCXで始まる名前: インポーターがモデルの衝突判定として扱う",
    "Names that end with -convcolonly: the importer creates bodies with these shapes":
        "-convcolonlyで終わる名前: インポーターが形状を持つボディにする",
    "Names with collider, for children that get a convex Mesh Collider":
        "colliderを含む名前: そこで凸のMesh Colliderを付ける子オブジェクト用",
    "Rigid Body":
        "リジッドボディ",
    "Blender's rigid body: the model falls and rolls with the hulls as its shape":
        "Blender自身のもの: モデルが落ちて転がり、凸包がその形状になる",
    "{name} is linked from another file and can't be a rigid body: make it local first (Object > Relations > Make Local).":
        "{name} は別のファイルからリンクされているため、リジッドボディにできません。先にローカル化してください (オブジェクト > 関係 > ローカル化)。",
    "The name of {name} is too long for the names of its hulls: shorten it.":
        "{name} の名前が長すぎて、凸包にその名前を付けられません。短くしてください。",
    "Another object has the name {name}, which a hull needs: rename that object.":
        "凸包に付ける名前 {name} は別のオブジェクトが使っています。名前を変更してください。",
    "{count} convex hulls around {name} with {times:.2f} times its volume.":
        "{name} の周りに凸包を {count} 個作りました。合わせて体積の {times:.2f} 倍です。",
    "Count":
        "個数",
    "Primitives":
        "プリミティブ",
    "Replace a hull by a box, sphere, capsule or cylinder within this distance from it, relative as for Error; 0: hulls only":
        "凸包からこれ以上離れない場合に、直方体、球、カプセル、円柱を代わりに使う。割合は誤差と同じ。0: 凸包のみ",
    "The worker process {how} before it was done.":
        "作業プロセスは終わる前に{how}。",
    "Merging vertices by distance, or a voxel remesh, often helps.":
        "距離による頂点のマージやボクセルリメッシュで直ることがよくあります。",
    "The worker process gave a damaged answer.":
        "作業プロセスの答えが壊れていました。",
    "The worker process gave a damaged answer: {reason}":
        "作業プロセスの答えが壊れていました: {reason}",
    "The worker process returned the parts of another mesh.":
        "作業プロセスは別のメッシュの答えを返しました。",
    "There is no Python to run the worker process: {reason}.":
        "作業プロセスを動かす Python がありません: {reason}。",
    "The worker process could not be started: {reason}.":
        "作業プロセスを開始できませんでした: {reason}。",
    "The worker process did not begin in {seconds} seconds.":
        "作業プロセスは {seconds} 秒以内に始まりませんでした。",
    "The worker process {how} before it began.":
        "作業プロセスは始まる前に{how}。",
    "If this happens again, choose a Python 3 to run it: Python in the add-on's preferences, or the argument python.":
        "直らない場合は、実行する Python 3 を指定してください: アドオンのプリファレンスの「Python」、または引数 python。",
    "was killed (SIGKILL, possibly because memory ran out)":
        "強制終了されました (SIGKILL、おそらくメモリ不足)",
    "crashed ({reason})":
        "クラッシュしました ({reason})",
    "was interrupted (Ctrl-C)":
        "外から終了されました (Ctrl C)",
    "ended without an answer (exit code {code})":
        "答えを返さずに終了しました (終了コード {code})",
    "did not answer in {seconds} seconds":
        "は {seconds} 秒以内に応答しませんでした",
    "can't be started ({reason})":
        "を開始できません ({reason})",
    "there is none":
        "ひとつもありません",
    "Remove the parts of the active mesh, also those saved with the file. The mesh stays as it is":
        "アクティブなメッシュのパーツを、ファイルに保存されたものも含めて削除します。メッシュは変わりません",
    "{name} no longer has a part similar to {part}. Pick the part again, forget the name {part}, and remember the part under this name.":
        "{name} には {part} に似たパーツがもうありません。パーツを選び直し、名前 {part} を忘れてから、その名前で記憶してください。",
    "{name} has no remembered part {part}. Pick the part, and name it with Remember Part.":
        "{name} には記憶したパーツ {part} がありません。パーツを選び、「パーツを記憶」で名前を付けてください。",
    "{name} has a Multiresolution modifier, whose details would be lost. Apply the modifier first.":
        "{name} には多重解像度モディファイアーがあり、そのディテールが失われます。先にモディファイアーを適用してください。",
    "{name} has a Multiresolution modifier: the new objects have only its coarsest level. To keep the details, apply the modifier first.":
        "{name} には多重解像度モディファイアーがあります。新しいオブジェクトが持つのは最も粗いレベルだけです。ディテールを残すには、先にモディファイアーを適用してください。",
    "Duplicate Selection":
        "選択部分を複製",
    "The mesh is too broken for this. Remesh it and try again.":
        "メッシュの破損がひどく、処理できません。リメッシュしてからもう一度試してください。",
    "So many triangles pass through each other that the inside can't be found. Remesh the model, or unite its parts with a Boolean.":
        "多くの三角形が互いに貫通しているため、内側を判定できません。リメッシュするか、ブーリアンでパーツを統合してください。",
    "There is not enough memory. Close other programs, or decimate the mesh.":
        "メモリーが足りません。他のプログラムを閉じるか、メッシュをデシメートしてください。",
    "No vertex is free to deform: the handle must be smaller than the part, and connected with it.":
        "変形できる頂点がありません。ハンドルはパーツより小さく、パーツとつながっている必要があります。",
    "The shape keys of {names} are lost; the parts keep their current shape. The shape keys of {target} move only its own surface.":
        "{names} のシェイプキーは失われ、パーツは現在の形のままになります。{target} のシェイプキーは、その元の表面だけを動かします。",
    "The model has {count:,} duplicate faces. The objects contain each of them once.":
        "モデルには重複した面が {count:,} 個あります。オブジェクトにはそれぞれ 1 つだけ含まれます。",
    "The volumes of the objects add up to {total:.4g}, but the model's volume is {whole:.4g}, because its surface is broken. Repair the mesh, or turn off Closed.":
        "オブジェクトの体積の合計は {total:.4g} ですが、モデルの体積は {whole:.4g} です。表面が破損しているためです。メッシュを修復するか、「閉じる」をオフにしてください。",
    "Only the mesh of {name} itself is printed, without the effect of its modifiers. To print it, apply them first.":
        "印刷されるのは {name} のメッシュそのもので、モディファイアーの効果は含まれません。含めるには、先にモディファイアーを適用してください。",
    "How the part follows the handle":
        "パーツがハンドルにどう追従するか",
    "How the parts change the current selection":
        "パーツが現在の選択をどう変更するか",
    "The part is the whole model, which has no other side. Pick a smaller one.":
        "このパーツはモデル全体で、反対側がありません。より小さいパーツを選んでください。",
    "The part is the whole model: nothing would be left without it. Pick a smaller one.":
        "このパーツはモデル全体です。取り除くと何も残りません。より小さいパーツを選んでください。",
    "The scene is linked from another file, so no object can be added to it.":
        "シーンは他のファイルからリンクされているため、オブジェクトを追加できません。",
    "The modifier {modifier} is bound to the vertices of {name}, which change: bind it again afterwards.":
        "モディファイアー {modifier} は {name} の頂点にバインドされていますが、頂点が変わります。後でもう一度バインドしてください。",
    "The selection must be exactly one whole part. Pick the part again with Select Part by Wheel, and confirm it.":
        "選択はちょうど 1 つのパーツ全体でなければなりません。「ホイールでパーツを選択」でパーツを選び直し、確定してください。",
    "New Part":
        "新しいパーツ",
}
