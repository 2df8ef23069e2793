# Prints what Godot 3 has imported from chair_godot.glb, and quits.
extends SceneTree

func _init():
	var meshes = 0
	var bodies = 0
	for node in everything(load("res://chair_godot.glb").instance()):
		if node is MeshInstance:
			meshes += 1
			print(node.name, ": MeshInstance, ", node.mesh.get_faces().size() / 3, " triangles")
		if node is StaticBody:
			bodies += 1
			var shape = node.get_child(0).shape
			print(node.name, ": StaticBody, ", shape.get_class(), ", ", shape.points.size(), " points")
	print(meshes, " mesh, ", bodies, " static bodies")
	quit()

func everything(node):
	var all = [node]
	for child in node.get_children():
		all += everything(child)
	return all
