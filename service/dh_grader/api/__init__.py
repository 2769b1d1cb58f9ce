"""The HTTP interface: routes that read requests and send responses.

The rules of what is sent are in the packages below: this one knows only HTTP.
"""
