"""The misconceptions that explain wrong answers.

Importing this package registers all misconceptions: its modules register their own.
"""

import dh_grader as service
