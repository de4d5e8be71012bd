// Made from the routes of kineme/studio by make_messages.py; change them there.

/** What is asked for; names in braces are filled in. */
export type GetPath =
  | "/api/annotators"
  | "/api/events"
  | "/api/export/{format}"
  | "/api/library"
  | "/api/library/figure"
  | "/api/recordings/{id}"
  | "/api/recordings/{id}/curves"
  | "/api/recordings/{id}/curves/{curve}/{level}/{number}"
  | "/api/recordings/{id}/cycles"
  | "/api/recordings/{id}/cycles/{cluster}"
  | "/api/recordings/{id}/export/{format}"
  | "/api/recordings/{id}/loops"
  | "/api/recordings/{id}/loops/{number}"
  | "/api/recordings/{id}/matrix/{level}/{row}/{column}"
  | "/api/recordings/{id}/motion"
  | "/api/recordings/{id}/progress"
  | "/api/recordings/{id}/versions"
  | "/api/recordings/{id}/versions/{number}"
  | "/api/recordings/{id}/video"
  | "/api/state"
  | "/api/tables";

/** Where something is sent to. */
export type PostPath =
  | "/api/agreement"
  | "/api/knowledge"
  | "/api/labels"
  | "/api/library/edits"
  | "/api/library/everywhere"
  | "/api/library/names"
  | "/api/library/search"
  | "/api/library/tables"
  | "/api/names"
  | "/api/recordings"
  | "/api/recordings/{id}/cancel"
  | "/api/recordings/{id}/clips"
  | "/api/recordings/{id}/compare"
  | "/api/recordings/{id}/edits"
  | "/api/recordings/{id}/lanes"
  | "/api/recordings/{id}/preview"
  | "/api/recordings/{id}/reading"
  | "/api/recordings/{id}/video";
