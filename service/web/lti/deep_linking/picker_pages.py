"""The page on which a tutor chooses exercises, and the form that sends links to the platform."""

from service.api.http.lookup import Catalogue
from service.translations import Language
from service.web.assets import Assets
from service.web.catalogue_words import kinds_of
from service.web.lti.deep_linking.offers import Offer, Picked
from service.web.lti.lti_pages import found, lti_page


def picker_page(
    offer: Offer,
    picked: Picked,
    ticket: str,
    catalogue: Catalogue,
    assets: Assets,
    language: Language,
) -> bytes:
    """Return the page on which a tutor chooses exercises."""
    # It works without scripts.
    chosen = picked.points or {}
    return lti_page(
        "picker.html",
        assets,
        [],
        ["catalogue.css", "picker.css"],
        language=language,
        offer=offer,
        picked=picked,
        chosen=chosen,
        exercises=found(catalogue, language, picked.search, chosen),
        kinds_of=kinds_of,
        ticket=ticket,
    )


def return_page(address: str, response: str, assets: Assets, language: Language) -> bytes:
    """Return the page that sends the signed ``response`` to the platform."""
    values = {"address": address, "response": response}
    return lti_page("return.html", assets, ["send_form.js"], language=language, **values)
