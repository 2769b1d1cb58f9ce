"""The page "DH in ten minutes" shows the correct matrix of a table row."""

import asyncio
import html
import re
from collections.abc import Mapping

import httpx
import pytest
import sympy as sp
from dh_grader.api.application import application
from dh_grader.catalogue import Exercise
from dh_grader.web import web_routes

# Spong, Hutchinson, Vidyasagar, section 3.2; Craig, section 3.4.
MOVES = {"standard": "Rotzθ Transzd Transxa Rotxα", "modified": "Rotxα Transxa Rotzθ Transzd"}
SIGNS = str.maketrans({"\u2061": "", "\u2062": "*", "−": "-", "θ": "theta", "α": "alpha"})
TAGS = re.compile("<[^>]*>")


def move(name: str) -> sp.Matrix:
    axis, amount = "xyz".index(name[-2]), sp.Symbol(name[-1].translate(SIGNS))
    made = sp.eye(4)
    if name.startswith("Trans"):
        made[axis, 3] = amount
        return made
    one, other = (axis + 1) % 3, (axis + 2) % 3
    made[one, one] = made[other, other] = sp.cos(amount)
    made[other, one], made[one, other] = sp.sin(amount), -sp.sin(amount)
    return made


def factors(text: str) -> tuple[bool, list[str]]:
    return text.startswith("-"), sorted(text.removeprefix("-").split("*"))


async def page(catalogue: Mapping[str, Exercise]) -> str:
    app = application(catalogue, pages=web_routes(catalogue))
    transport = httpx.ASGITransport(app)
    async with httpx.AsyncClient(transport=transport, base_url="http://service") as client:
        return (await client.get("/learn-dh")).text


@pytest.mark.parametrize("convention", MOVES)
def test_the_matrix_of_a_row_is_the_product_of_its_moves(
    catalogue: Mapping[str, Exercise], convention: str
) -> None:
    told = html.unescape(asyncio.run(page(catalogue))).partition('id="link-transform"')[2]
    shown = told.partition(f'{convention}"><b class="which">')[2].partition("</div>")[0]
    moves, _, matrix = shown.partition('<div class="display">')
    named = re.sub(r"[()]", "", TAGS.sub("", moves.partition("</b>")[2]))
    assert " ".join(named.split()) == f"Ai = {MOVES[convention]} ="
    entries = [
        factors(TAGS.sub("", each).translate(SIGNS))
        for each in re.findall("<mtd>(.*?)</mtd>", matrix)
    ]
    product = sp.eye(4)
    for each in MOVES[convention].split():
        product *= move(each)
    assert entries == [factors(str(each)) for each in product]
