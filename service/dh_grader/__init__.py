"""DH Grader: grades submissions of robotics students against a reference robot."""

import os
from importlib.metadata import version
from typing import Final

# The matrices of an arm are small: threads of numpy's linear algebra would only wait for each
# other, for seconds on a busy machine. numpy reads these variables when it is imported.
for _variable in ("OPENBLAS_NUM_THREADS", "OMP_NUM_THREADS", "MKL_NUM_THREADS"):
    os.environ.setdefault(_variable, "1")


# --- The installed version of the program


VERSION: Final = version("dh-grader")
