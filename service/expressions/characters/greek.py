"""Greek letters and their ASCII names."""

from itertools import product
from typing import Final

NAMES: Final = {
    "α": "alpha", "β": "beta", "γ": "gamma", "δ": "delta", "ε": "epsilon", "ζ": "zeta",
    "η": "eta", "θ": "theta", "ι": "iota", "κ": "kappa", "λ": "lambda", "μ": "mu", "ν": "nu",
    "ξ": "xi", "ρ": "rho", "σ": "sigma", "τ": "tau", "υ": "upsilon", "φ": "phi",
    "χ": "chi", "ψ": "psi", "ω": "omega", "π": "pi",
    "Γ": "Gamma", "Δ": "Delta", "Θ": "Theta", "Λ": "Lambda", "Ξ": "Xi", "Π": "Pi", "Σ": "Sigma",
    "Φ": "Phi", "Ψ": "Psi", "Ω": "Omega",
}  # fmt: skip
LETTERS: Final = {name: letter for letter, name in NAMES.items()}
# Other shapes of the same letter: ϑ is θ, ϕ is φ, the micro sign is μ.
VARIANTS: Final = {"ϑ": "θ", "ϕ": "φ", "ϵ": "ε", "ϱ": "ρ", "ς": "σ", "ϖ": "π", "µ": "μ", "Ω": "Ω",
                   "∆": "Δ", "ϰ": "κ"}  # fmt: skip
CLASS: Final = "".join(NAMES)


def spellings(name: str) -> set[str]:
    """All ways to write ``name``, with each Greek letter as such or spelled out.

    The letters stay letters in the text itself: spelled out there, ``bη`` would read as beta.
    """
    parts: list[tuple[str, ...]] = []
    position = 0
    while position < len(name):
        letter = name[position]
        spelled = next((word for word in _LONGEST_FIRST if name.startswith(word, position)), None)
        if letter in NAMES:
            parts.append((letter, NAMES[letter]))
            position += 1
        elif spelled is not None and (position == 0 or not name[position - 1].isalpha()):
            parts.append((spelled, LETTERS[spelled]))
            position += len(spelled)
        else:
            parts.append((letter,))
            position += 1
    return {"".join(choice) for choice in product(*parts)}


_LONGEST_FIRST: Final = sorted(LETTERS, key=len, reverse=True)
