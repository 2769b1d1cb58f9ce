"""Greek letters and their ASCII names."""

import re
from itertools import product
from typing import Final

from service.regex import regex

NAMES: Final = {
    "α": "alpha", "β": "beta", "γ": "gamma", "δ": "delta", "ε": "epsilon", "ζ": "zeta",
    "η": "eta", "θ": "theta", "ι": "iota", "κ": "kappa", "λ": "lambda", "μ": "mu", "ν": "nu",
    "ξ": "xi", "ρ": "rho", "σ": "sigma", "τ": "tau", "υ": "upsilon", "φ": "phi",
    "χ": "chi", "ψ": "psi", "ω": "omega", "π": "pi",
    "Γ": "Gamma", "Δ": "Delta", "Θ": "Theta", "Λ": "Lambda", "Ξ": "Xi", "Π": "Pi", "Σ": "Sigma",
    "Φ": "Phi", "Ψ": "Psi", "Ω": "Omega",
}  # fmt: skip
LETTERS: Final = {name: letter for letter, name in NAMES.items()}
# Variants of the same letter: ϑ is θ, ϕ is φ, the micro sign is μ.
VARIANTS: Final = {"ϑ": "θ", "ϕ": "φ", "ϵ": "ε", "ϱ": "ρ", "ς": "σ", "ϖ": "π", "µ": "μ", "Ω": "Ω",
                   "∆": "Δ", "ϰ": "κ"}  # fmt: skip
CLASS: Final = "".join(NAMES)
# A letter's name must begin a word: theta1, but not the eta in beta.
_SPELLED: Final = "|".join(sorted(LETTERS, key=len, reverse=True))
_PARTS: Final = regex(rf"(?<![^\W\d_])(?:{_SPELLED})|.", re.DOTALL)


def spellings(name: str) -> set[str]:
    """Return all ways to write ``name``: each Greek letter as a letter or as its name."""
    # Student texts are not converted this way, because ``bη`` (b times η) would become ``beta``.
    both = NAMES | LETTERS
    parts = [{part, both.get(part, part)} for part in _PARTS.findall(name)]
    return {"".join(choice) for choice in product(*parts)}
