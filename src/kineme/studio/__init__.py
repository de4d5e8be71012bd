"""Studio: a local server and a page to look at recordings and correct their segments.

    server   a socket of this machine, Ctrl+C, the browser
      app      routes ─▶ open recordings, behind http.security: host, origin, token, headers
        http              bodies of requests and answers, uploads, events
        open_recordings   by id; each is opened once
          sketches            what a large file shows of itself while it is read
          reader              how files are read, and which of several people a recording is of
          open_recording      table, revision, undo, saving of each; segments found in a thread
          loading             the recording itself and all that is computed from it; reading
          edits               what each edit does to a table
          storage.tables      the table beside the recording, and whether someone else changed it
          storage.journal     undo, redo, and the tables that were replaced, on the disk
          storage.sidecars    what people said of a recording, in small files beside it
        folder            what there is to open, names and ids; progress of each
        choices           what the page offers: presets, constants, formats
        downloads         segments, clips and reports as files
        library           the same for a library, at library_routes: clusters as cards, searches

Everything that a page sends is checked as it is decoded into the types of
`kineme.web.requests`. No path is ever made from what a page sends: files are found by ids, and an
upload's name is made anew.
"""
