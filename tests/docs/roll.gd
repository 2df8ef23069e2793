# Rolls a ball through the door of house_godot.glb, prints where it comes to rest and the shapes of the models, and quits.
extends SceneTree

var ball = RigidBody.new()
var frames = 0

func _initialize():
	for model in ["house", "Knight"]:
		var shapes = 0
		var scene = load("res://" + model + "_godot.glb").instance()
		root.add_child(scene)
		scene.translation.x = 0 if model == "house" else 100
		for node in everything(scene):
			if node is CollisionShape:
				shapes += 1
		print(model, ": ", shapes, " shapes")
	var sphere = CollisionShape.new()
	sphere.shape = SphereShape.new()
	sphere.shape.radius = 0.4
	ball.add_child(sphere)
	root.add_child(ball)
	ball.translation = Vector3(3.5, 0.41, 0.45)
	ball.linear_velocity = Vector3(0, 0, -3)

func _iteration(_delta):
	frames += 1
	if frames < 60:
		return false
	print("ball: ", "inside" if ball.translation.z < -1 and ball.translation.y > 0 else "outside", " at ", ball.translation)
	quit()
	return false

func everything(node):
	var all = [node]
	for child in node.get_children():
		all += everything(child)
	return all
