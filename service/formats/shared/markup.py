"""Elements of HTML and XML. Whatever text they are given is escaped when they are written."""

from xml.etree.ElementTree import Element

from service.formats.shared.plain_text import visible

Child = Element | str


def element(tag: str, *children: Child, **attributes: str) -> Element:
    """An element with its children in order.

    Each text is one visible line, without what XML forbids. In the name of an attribute ``_`` is
    written for ``-``, and behind a name that Python keeps for itself: ``aria_label``, ``class_``.
    """
    named = {name.rstrip("_").replace("_", "-"): value for name, value in attributes.items()}
    made = Element(tag, {name: visible(value) for name, value in named.items()})
    for child in children:
        if isinstance(child, Element):
            made.append(child)
        elif len(made):
            made[-1].tail = (made[-1].tail or "") + visible(child)
        else:
            made.text = (made.text or "") + visible(child)
    return made
