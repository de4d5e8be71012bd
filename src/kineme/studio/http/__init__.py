"""What comes and goes over the network: bodies of requests, answers, events, who may ask."""

import mimetypes

mimetypes.add_type("text/javascript", ".js")  # the registry of Windows may say something else
