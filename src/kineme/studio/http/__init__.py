"""HTTP: request and response bodies, uploads, server-sent events and access control."""

import mimetypes

mimetypes.add_type("text/javascript", ".js")  # the Windows registry may map it to another type
