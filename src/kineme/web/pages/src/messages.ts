// Made from kineme/web (messages, requests) by make_messages.py; change them there.

export type Level = "activity" | "primitive";

export type Kind = "activity" | "primitive" | "transition";

/** A row of the segment table with its annotations, which are unset by default. */
export interface Segment {
  level: Level;
  kind: Kind;
  start_frame: number;
  stop_frame: number;
  start_s: number;
  stop_s: number;
  cluster: number;
  activity: number;
  label: string;
  confidence: number | null;
  action: number;
  border_confidence: number | null;
  checked?: boolean;
  excluded?: boolean;
  comment?: string;
}

export type Edit = MoveBorder | Split | Merge | DeleteBorder | NameSegment | NameCluster | SetCluster | SetKind | MergeClusters | SplitCluster | OrderClusters | Remark | Check | Exclude | Together | SegmentAgain | TakeLabels | Transfer | Restore | Undo | Redo;

/** A segment table in its JSON format (`kineme.segments/2`), with annotations in the rows. */
export interface Segments {
  schema: string;
  n_frames: number;
  fps: number;
  provenance: Record<string, unknown>;
  timings: Record<string, number>;
  segments: Segment[];
  cluster_names: Record<string, string>;
}

/** Layout of the binary motion; see `kineme.web.display`. */
export interface MotionHead {
  n_samples: number;
  sample_fps: number;
  joints: string[];
  parents: number[];
  bones: [number, number][];
  origin: [number, number, number];
  step: number;
  heading: number[] | null;
  effectors: Record<string, number>;
}

/** Pyramid of self-similarity tiles; see `kineme.web.matrix`. */
export interface MatrixHead {
  fps: number;
  tile: number;
  sizes: number[];
}

/** A curve over time, such as a joint's height or a channel; `group` is its quantity. */
export interface Curve {
  name: string;
  group: string;
  unit: string;
}

/** Curves of a recording and the layout of their levels; see `kineme.web.curves`. */
export interface CurveList {
  curves: Curve[];
  factor: number;
  tile: number;
  levels: number;
}

/** A channel that can be measured for each repetition, as in `kineme info --channels`. */
export interface CycleChannel {
  name: string;
  unit: string;
  group: string;
  opposite: string;
}

/** Channels of a recording; those measured by default come first. */
export interface CycleChannels {
  channels: CycleChannel[];
}

/** A repetition, sampled evenly from 0 to 100 % of the cycle; null if missing. */
export interface CycleCurve {
  start_frame: number;
  start_s: number;
  stop_s: number;
  counts: boolean;
  note: string;
  distance: number | null;
  values: (number | null)[];
}

/** Mean curve of the same movement in another recording, over `n` of `total` repetitions. */
export interface OtherSession {
  n: number;
  total: number;
  mean: (number | null)[];
  sd: (number | null)[];
  differs: boolean[];
}

/** A channel over the repetitions of a cluster, and of clusters with the same name. */
export interface ClusterCurves {
  channel: string;
  unit: string;
  n: number;
  total: number;
  ends: boolean;
  left_out: number;
  turned: number;
  mean: (number | null)[];
  sd: (number | null)[];
  cycles: CycleCurve[];
  beside: OtherSession | null;
}

/** Curves in a report. */
export interface ReportCurves {
  channels: CycleChannel[];
  curves: Record<string, ClusterCurves>[];
  tables: Record<string, number>[];
}

/** Table of the same recording at another detail; below 1 is coarser. */
export interface TableAtDetail {
  detail: number;
  segments: Segment[];
}

/** Keypoints drawn over a video with this size in pixels; see `kineme.web.display`. */
export interface Picture {
  width: number;
  height: number;
  keypoints: MotionHead;
}

/** A video of the recording, and the time in it at which the recording starts, in seconds. */
export interface Video {
  name: string;
  offset_s: number;
  picture?: Picture;
  address?: string;
}

/** Everything that a page needs of a recording except the binary parts. */
export interface Recording {
  id: string;
  name: string;
  n_frames: number;
  fps: number;
  motion: MotionHead | null;
  matrix: MatrixHead;
  segmentation: Segments;
  levels: TableAtDetail[];
  video: Video | null;
  read_options: Record<string, unknown>;
  take?: string | null;
  takes?: string[];
  file?: string;
  person?: string | null;
  people?: string[];
  revision: number;
  can_undo: boolean;
  can_redo: boolean;
  saved: string;
  finding?: boolean;
  being_read?: boolean;
  warnings: string[];
}

/** Rows in which a table differs from that of the revision `of`. */
export interface TableChange {
  of: number;
  removed: [Level, number][];
  rows: Segment[];
  cluster_names: Record<string, string>;
}

/** Result of an edit, already saved in the file `saved`. */
export interface Edited {
  revision: number;
  change: TableChange | null;
  segmentation: Segments | null;
  can_undo: boolean;
  can_redo: boolean;
  saved: string;
  notes: string[];
}

/** Title of a score, and what it measures. */
export interface ScoreMeaning {
  title: string;
  help: string;
}

/** Another result, and the agreement of the shown table with it. */
export interface Comparison {
  name: string;
  segmentation: Segments;
  scores: Record<string, number>;
  meanings?: Record<string, ScoreMeaning>;
  differences?: [number, number][];
}

/** A table that could replace the present one. */
export interface Preview {
  segmentation: Segments;
  corrections: number;
  names: number;
  lost: string[];
  details: number[];
  detail: number;
}

/** A table that was replaced; `edit` made it, null for a segmentation or a foreign table. */
export interface Version {
  number: number;
  at: string;
  edit: MoveBorder | Split | Merge | DeleteBorder | NameSegment | NameCluster | SetCluster | SetKind | MergeClusters | SplitCluster | OrderClusters | Remark | Check | Exclude | Together | SegmentAgain | TakeLabels | Transfer | Restore | Undo | Redo | null;
  segments: number;
  corrections: number;
  names: number;
}

/** Tables of a recording that were replaced, the latest first. */
export interface Versions {
  versions: Version[];
}

/** A repetition as a loop: the number of its row in the table, and its quality. */
export interface LoopRow {
  number: number;
  rank: number;
  cost: number;
  pose_m: number;
  slide_m_s: number | null;
  turn_deg: number;
  speed_m_s: number;
}

/** Repetitions of a recording as loops, grouped by cluster, the best first. */
export interface Loops {
  loops: LoopRow[];
}

/** One round of a loop as it would be exported; the first frame is repeated at the end. */
export interface PlayedLoop {
  motion: MotionHead;
  numbers: string;
  turn: number;
  x: number;
  z: number;
}

/** Columns of a segment table that the page of a folder shows, and its annotations. */
export interface BriefTable {
  n_frames: number;
  fps: number;
  level: Level[];
  kind: Kind[];
  start_frame: number[];
  stop_frame: number[];
  cluster: number[];
  activity: number[];
  label: string[];
  confidence: (number | null)[];
  border_confidence: (number | null)[];
  checked: number[];
  comments: number;
}

/** A recording of the folder and its table; null if it is not segmented yet. */
export interface FolderRecording {
  id: string;
  table: BriefTable | null;
}

/** Tables of all recordings of the folder, in the order of the list. */
export interface FolderTables {
  recordings: FolderRecording[];
}

/** Stage of the computation for a recording, and the completed fraction, 0 to 1. */
export interface Progress {
  stage: string;
  share: number | null;
}

/** Progress of pose estimation for the video `recording`, which is empty if idle. */
export interface PosesProgress {
  recording: string;
  name: string;
  share: number | null;
  pace: number;
  done: number;
  all: number;
  failed: string[];
}

/** Sent to every page when a table has changed or a file was added. */
export interface Changed {
  recording: string;
  revision: number;
}

/** Reason why a request was refused, in one sentence; `people` are the people to choose from. */
export interface Failure {
  error: string;
  people?: string[];
  reading?: boolean;
  poses?: boolean;
}

/** A constant of a preset that the page offers to change. */
export interface Parameter {
  name: string;
  help: string;
  value: number;
  minimum: number;
  maximum: number;
  step: number;
  unit: string;
}

/** A preset and its constants that the page offers to change. */
export interface PresetChoice {
  name: string;
  help: string;
  parameters: Parameter[];
  signal_parameters: Parameter[];
}

/** A recording of the folder, opened or not; people in the same file have the same `file`. */
export interface Listing {
  id: string;
  file: string;
  name: string;
  bytes: number;
  needs_poses: boolean;
  corrected: boolean;
  segments: number;
  checked: number;
  named: number;
  to_name: number;
}

/** A knowledge base or label file of the folder. */
export interface FileChoice {
  id: string;
  name: string;
}

/** A format in which segments can be downloaded, and its suffix. */
export interface ExportFormat {
  name: string;
  suffix: string;
  help: string;
}

/** What the studio offers; the first message that a page requests. */
export interface State {
  version: string;
  folder: string;
  of_library: boolean;
  suffixes: string[];
  recordings: Listing[];
  presets: PresetChoice[];
  default_preset: string;
  details: number[];
  labels: string[];
  knowledge_bases: FileChoice[];
  annotations: FileChoice[];
  export_formats: ExportFormat[];
  install: string;
}

/** Move the border at `frame` of a level to `to`. */
export interface MoveBorder {
  kind: "move_border";
  level: Level;
  frame: number;
  to: number;
}

/** Insert a border at `frame`. */
export interface Split {
  kind: "split";
  level: Level;
  frame: number;
}

/** Merge the segments in `[start_frame, stop_frame)`. */
export interface Merge {
  kind: "merge";
  level: Level;
  start_frame: number;
  stop_frame: number;
}

/** Merge the two segments that meet at `frame`; the longer one sets label and cluster. */
export interface DeleteBorder {
  kind: "delete_border";
  level: Level;
  frame: number;
}

/** Label the segment that starts at `frame`; an empty label removes it. */
export interface NameSegment {
  kind: "name_segment";
  level: Level;
  frame: number;
  label: string;
}

/** Label all segments of a cluster, on both levels. */
export interface NameCluster {
  kind: "name_cluster";
  cluster: number;
  label: string;
}

/** Move the segment that starts at `frame` to a cluster; -1 means none. */
export interface SetCluster {
  kind: "set_cluster";
  level: Level;
  frame: number;
  cluster: number;
}

/** Turn the segment that starts at `frame` into a transition without cluster, or back. */
export interface SetKind {
  kind: "set_kind";
  level: Level;
  frame: number;
  to: Kind;
}

/** Segment the recording again by a preset; `keep` transfers corrections and names. */
export interface SegmentAgain {
  kind: "segment";
  preset: string;
  parameters: Record<string, number>;
  keep?: boolean;
  detail?: number;
}

/** Move all segments of a cluster to the cluster `into`. */
export interface MergeClusters {
  kind: "merge_clusters";
  cluster: number;
  into: number;
}

/** Move the primitives that start at `frames` from their cluster to a new one. */
export interface SplitCluster {
  kind: "split_cluster";
  cluster: number;
  frames: number[];
}

/** Renumber the clusters in this order. */
export interface OrderClusters {
  kind: "order_clusters";
  order: number[];
}

/** Comment on the segment that starts at `frame`; an empty comment removes it. */
export interface Remark {
  kind: "comment";
  level: Level;
  frame: number;
  text: string;
}

/** Mark the segments that start at `frames` as checked or unchecked. */
export interface Check {
  kind: "check";
  level: Level;
  frames: number[];
  checked: boolean;
}

/** Exclude the primitives that start at `frames` from all means, or include them again. */
export interface Exclude {
  kind: "exclude";
  frames: number[];
  excluded: boolean;
}

/** Replace the table by a label file of the folder. */
export interface TakeLabels {
  kind: "take_labels";
  annotation: string;
}

/** Restore a table that was replaced. */
export interface Restore {
  kind: "restore";
  version: number;
}

/** Label segments from a knowledge base of the folder. */
export interface Transfer {
  kind: "transfer";
  knowledge_base: string;
  threshold?: number;
  spread?: boolean;
}

/** Undo the last edit. */
export interface Undo {
  kind: "undo";
}

/** Redo the edit that was undone last. */
export interface Redo {
  kind: "redo";
}

export type ByHand = MoveBorder | Split | Merge | DeleteBorder | NameSegment | NameCluster | SetCluster | SetKind | MergeClusters | SplitCluster | OrderClusters | Remark | Check | Exclude;

/** Apply several edits as one undo step; all or none. */
export interface Together {
  kind: "together";
  edits: ByHand[];
}

/** An edit of the table with this revision. */
export interface EditRequest {
  revision: number;
  edit: Edit;
  name?: string;
}

/** Preview the result of `SegmentAgain`. */
export interface PreviewRequest {
  preset: string;
  parameters: Record<string, number>;
  keep: boolean;
  detail?: number;
}

/** Labels that all recordings of the folder share; the first nine are on the keys 1 to 9. */
export interface LabelsRequest {
  labels: string[];
}

/** Create a knowledge base with this name from the named primitives of recordings. */
export interface KnowledgeRequest {
  name: string;
  recordings: string[];
}

/** Export these rows of the table as motion files; with `loops` their ends are blended. */
export interface ClipsRequest {
  rows: number[];
  loops: boolean;
}

/** Time in the reference video at which the recording starts, in seconds. */
export interface VideoRequest {
  offset_s: number;
}

/** Videos whose poses are to be estimated. */
export interface PosesRequest {
  recordings: string[];
}

/** Reading options of a recording by name; they replace what the file states. */
export interface ReadRequest {
  options: Record<string, string | number | boolean | string[]>;
  everybody?: boolean;
}

/** Compare with another result: that of a preset, or a label file of the folder. */
export interface CompareRequest {
  preset?: string;
  annotation?: string;
}

/** A person who labelled this number of recordings of the folder. */
export interface AnnotatorChoice {
  id: string;
  name: string;
  recordings: number;
}

/** Ids of the people to compare. */
export interface AgreementRequest {
  annotators: string[];
}

/** Agreement of two people on the recordings that both labelled. */
export interface AgreementPair {
  annotators: [string, string];
  cohen_kappa: number | null;
  border_f1: number | null;
  recordings: number;
}

/** A span in seconds where labels differ, and the label of each person; empty if unlabelled. */
export interface Difference {
  start_s: number;
  stop_s: number;
  labels: string[];
}

/** Agreement of the people who labelled a recording, and where they differ. */
export interface RecordingAgreement {
  id: string;
  name: string;
  annotators: string[];
  fleiss_kappa: number | null;
  differences: Difference[];
}

/** Agreement of people over the folder. */
export interface Agreement {
  annotators: string[];
  by_names: boolean;
  fleiss_kappa: number | null;
  pairs: AgreementPair[];
  recordings: RecordingAgreement[];
  failures: string[];
}

/** Labels of one person for the open recording. */
export interface LabelLane {
  name: string;
  segmentation: Segments;
}

/** A recording of a library; `id` opens it in the studio and is empty if its file is gone. */
export interface LibraryRecording {
  recording: string;
  id: string;
  status: "as found" | "checked" | "corrected" | "gone";
  vocabulary: string;
  duration_s: number;
}

/** A cluster of a library; see `kineme.library.open_library.Cluster`. */
export interface LibraryCluster {
  cluster: number;
  label: string;
  vocabulary: string;
  recordings: number[];
  activities: number;
  repetitions: number;
  seconds: number;
  typical_s: number;
  example: string;
  start_s: number;
  stop_s: number;
  unsure: number;
}

/** A library: its recordings, its clusters, and files that could not be read, with the reason. */
export interface LibraryState {
  folder: string;
  hours: number;
  recordings: LibraryRecording[];
  clusters: LibraryCluster[];
  failed: Record<string, string>;
  undo: string;
}

/** A match of a search; `label` is that of the cluster. */
export interface LibraryHit {
  recording: string;
  start_s: number;
  stop_s: number;
  distance: number;
  cluster: number;
  label: string;
  name?: string;
}

/** Matches of a search, the nearest first. */
export interface LibraryHits {
  hits: LibraryHit[];
}

/** Number of hits that were named, and reasons for those that were not. */
export interface NamedHits {
  named: number;
  left: string[];
}

/** A small figure of a span: a motion with its numbers in base 64, or curves. */
export interface LibraryFigure {
  motion: MotionHead | null;
  numbers: string;
  curves: number[][];
}

/** A span of a recording of the library. */
export interface Span {
  recording: string;
  start_s: number;
  stop_s: number;
}

/** Search for the spans in `like` or a cluster; leave out what is nearer to `unlike`. */
export interface SearchRequest {
  like: Span[];
  unlike: Span[];
  threshold: number;
  top: number;
  mirror: boolean;
  cluster?: number;
}

/** Name the segments that hits show; an empty name removes the name. */
export interface CallHits {
  name: string;
  hits: Span[];
}

/** Name a cluster of the library; an empty name removes the name. */
export interface CallCluster {
  kind: "name";
  cluster: number;
  name: string;
}

/** Merge other clusters into a cluster of the library, which keeps its number and name. */
export interface JoinClusters {
  kind: "merge";
  cluster: number;
  others: number[];
}

/** Move the part of a cluster in some recordings to a new cluster. */
export interface PartCluster {
  kind: "split";
  cluster: number;
  recordings: string[];
}

/** Undo the last edit of the clusters of the library. */
export interface UndoEdit {
  kind: "undo";
}

export type LibraryEdit = CallCluster | JoinClusters | PartCluster | UndoEdit;

/** Update clusters and names of saved tables from the library. */
export interface TablesRequest {
  names: boolean;
}

/** Rename a cluster of one recording in all recordings. */
export interface CallEverywhere {
  recording: string;
  cluster: number;
  before: string;
  label: string;
}

/** Number of changed tables, number of clusters that kept another name, and failures. */
export interface TablesChanged {
  tables: number;
  others: number;
  left: string[];
}

/** An event of a stream; fields that its kind does not have are 0 or empty. */
export interface LiveEvent {
  event: "ActivityEnded" | "ActivityStarted" | "Gap" | "Notice" | "Repetition";
  at_s: number;
  state: "final" | "provisional";
  start_s: number;
  stop_s: number;
  cluster: number;
  label: string;
  number: number;
  repetitions: number;
  text: string;
}

/** Constant data of a stream: names of the curves, and joints that are connected. */
export interface LiveHead {
  channels: string[];
  sample_fps: number;
  bones: [number, number][];
}

/** Changes since the previous update; only the first one has a head. */
export interface LiveUpdate {
  head: LiveHead | null;
  now_s: number;
  silent_s: number;
  has_ended: boolean;
  events: LiveEvent[];
  first_s: number;
  samples: ((number | null)[])[];
  pose: (number | null)[];
}

/** A row of which nothing is known. */
export const bareSegment: Segment = {
  level: "activity",
  kind: "activity",
  start_frame: 0,
  stop_frame: 0,
  start_s: 0.0,
  stop_s: 0.0,
  cluster: -1,
  activity: 0,
  label: "",
  confidence: null,
  action: -1,
  border_confidence: null,
};
