"""Views: arrays without a copy, which never dangle."""
# SPDX-License-Identifier: LGPL-3.0-or-later
import gc
import unittest

import numpy as np

import incise
import support


class Views(unittest.TestCase):
    def test_view_shows_the_memory_of_the_world(self) -> None:
        body = support.world(gravity=[0, 0, -9])
        body.run_until(0.01)
        with body.view() as view:
            shown = view.positions
            self.assertFalse(shown.flags.writeable)
            self.assertFalse(shown.flags.owndata)
            np.testing.assert_array_equal(shown, body.positions)
            np.testing.assert_array_equal(view.velocities, body.velocities)
            np.testing.assert_array_equal(view.rest_positions, body.rest_positions)
            with self.assertRaises(ValueError):
                shown[0, 0] = 1.0

    def test_steps_raise_buffer_error_meanwhile(self) -> None:
        body = support.world()
        state = body.save()
        with body.view():
            for call in (body.step, lambda: body.run_until(1.0), lambda: body.restore(state)):
                with self.assertRaises(BufferError):
                    call()
            self.assertEqual(body.num_steps, 0)
        body.step()

    def test_an_array_that_is_kept_holds_the_world_still(self) -> None:
        body = support.world()
        with body.view() as view:
            kept = view.positions[2:4]
        with self.assertRaises(BufferError):
            body.step()
        del kept
        body.step()

    def test_arrays_keep_the_world_alive(self) -> None:
        body = support.world()
        expected = body.positions
        with body.view() as view:
            kept = view.positions
        del body, view
        gc.collect()
        filler = [support.world() for _ in range(5)]
        np.testing.assert_array_equal(kept, expected)
        del filler

    def test_a_view_is_for_a_with_statement(self) -> None:
        body = support.world()
        view = body.view()
        with self.assertRaises(incise.Error):
            view.positions
        with view:
            with self.assertRaises(incise.Error):
                view.__enter__()
        with self.assertRaises(incise.Error):
            view.positions
        body.step()

    def test_an_exception_closes_the_view(self) -> None:
        body = support.world()
        with self.assertRaises(KeyError):
            with body.view():
                raise KeyError
        body.step()

    def test_a_forgotten_view_is_no_obstacle(self) -> None:
        body = support.world()
        view = body.view()
        view.__enter__()
        del view
        gc.collect()
        body.step()


if __name__ == "__main__":
    unittest.main()
