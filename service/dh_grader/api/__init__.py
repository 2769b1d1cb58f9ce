"""The HTTP interface: routes that read requests and send responses.

What an answer means is decided in other packages; this one knows only HTTP. ``application.py``
puts the routes together, ``http.py`` has what all routes share.
"""
