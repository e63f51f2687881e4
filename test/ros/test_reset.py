from node_client import NodeTest
from scenes import add_random_scene, exact, ids_of, particle


class TestReset(NodeTest):
    def test_puts_every_particle_where_it_was_last_added_or_set(self):
        add_random_scene(self.node, seed=4)
        added = self.node.get_scene()
        self.node.step(steps=50)
        ids = list(added.particle_ids)
        self.node.set_particles(ids[3:4], [particle((1, 0, 0), (0, 1, 2), mass=3)])
        given = self.node.get_scene().particles[3]
        self.node.step(steps=50)
        self.assertNotEqual(exact(added.particles), exact(self.node.get_scene().particles))

        self.node.reset()
        added.particles[3] = given
        self.assertEqual(exact(added), exact(self.node.get_scene()))

    def test_begins_time_and_the_account_anew(self):
        add_random_scene(self.node, seed=5)
        moved = self.node.step(steps=50)
        self.assertGreater(moved.energies.dissipated, 0)
        self.node.reset()
        now = self.node.step(steps=0)
        self.assertEqual((0, 0, 0), (now.time, now.energies.time, now.energies.dissipated))
        again = self.node.step(steps=50)
        self.assertEqual(moved.energies.total, again.energies.total)
        self.assertEqual(moved.energies.dissipated, again.energies.dissipated)


class TestClear(NodeTest):
    def test_leaves_nothing(self):
        add_random_scene(self.node, seed=6)
        self.node.step(steps=50)
        self.node.clear()
        scene = self.node.get_scene()
        self.assertEqual(0, scene.time)
        self.assertEqual(([], []), (list(scene.particle_ids), scene.particles))
        self.assertEqual([[], [], []], list(ids_of(scene).values()))
        self.assertEqual((0, 0), (self.node.step(steps=0).energies.total, self.node.step(steps=0).time))
