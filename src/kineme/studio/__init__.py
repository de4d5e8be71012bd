"""Studio: a local web server and a page for viewing recordings and correcting their segments.

    server   the socket, Ctrl+C, opening the browser
      app      routes ─▶ open recordings, behind http.security: host, origin, token, headers
        http              request and response bodies, uploads, events
        open_recordings   recordings by id; each is opened once
          sketches            a preview of a large file while it is read
          reader              reading options, and the selected person of a file with several
          open_recording      table, revision, undo and saving; segments found in a thread
          loading             the recording and everything computed from it
          edits               what each edit does to a table
          storage.tables      the table file beside the recording; detects changes by others
          storage.journal     undo, redo and replaced tables, on the disk
          storage.sidecars    user settings of a recording, in small files beside it
        folder            files that can be opened, their names, ids and progress
        choices           presets, constants and formats that the page offers
        downloads         segments, clips and reports as files
        library           the same for a library, served by library_routes: clusters, searches

Everything that a page sends is checked as it is decoded into the types of `kineme.web.requests`. No
path is ever built from a request: files are found by id, and the name of an upload is sanitised.
"""
