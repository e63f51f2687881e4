"""A client of the actions of the node."""

import actionlib
from actionlib_msgs.msg import GoalStatus

from node_client import wait_until


class ActionClient(actionlib.SimpleActionClient):
    """A client of one action that keeps the feedback of its goal."""

    def __init__(self, node, name, action):
        super().__init__(node.name + '/' + name, action)
        if not self.wait_for_server():
            raise AssertionError('there is no server of ' + name)
        self.feedback = []

    def begin(self, goal):
        """Send a goal; return when it is under way."""
        self.feedback = []
        self.send_goal(goal, feedback_cb=self.feedback.append)
        wait_until(lambda: self.get_state() == GoalStatus.ACTIVE)

    def ended(self):
        """The state, the text and the result of the goal, once it has ended."""
        wait_until(lambda: self.get_state() not in (GoalStatus.PENDING, GoalStatus.ACTIVE))
        wait_until(lambda: self.get_result() is not None)
        return self.get_state(), self.get_goal_status_text(), self.get_result()

    def outcome(self, goal):
        self.send_goal(goal)
        return self.ended()
