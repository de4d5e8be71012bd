// Made from kineme/web (messages, requests) by make_messages.py; change them there.

export type Level = "activity" | "primitive";

export type Kind = "activity" | "primitive" | "transition";

/** A row of the segment table, and what people did to it where they did something. */
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

/** A segment table as its JSON file has it (`kineme.segments/2`), marks in its rows. */
export interface Segments {
  schema: string;
  n_frames: number;
  fps: number;
  provenance: Record<string, unknown>;
  timings: Record<string, number>;
  segments: Segment[];
  cluster_names: Record<string, string>;
}

/** How to read the binary motion; see `kineme.web.display`. */
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

/** A curve over time: a joint's height, a channel; `group` says what it is of that name. */
export interface Curve {
  name: string;
  group: string;
  unit: string;
}

/** Curves of a recording and their levels; see `kineme.web.curves`. */
export interface CurveList {
  curves: Curve[];
  factor: number;
  tile: number;
  levels: number;
}

/** What can be measured of a repetition, as `kineme info --channels` has it. */
export interface CycleChannel {
  name: string;
  unit: string;
  group: string;
  opposite: string;
}

/** Channels of a recording, those first that are measured where nobody says which. */
export interface CycleChannels {
  channels: CycleChannel[];
}

/** A repetition: from 0 to 100 % of the cycle, evenly; null where nothing was recorded. */
export interface CycleCurve {
  start_frame: number;
  start_s: number;
  stop_s: number;
  counts: boolean;
  note: string;
  distance: number | null;
  values: (number | null)[];
}

/** Mean curve of the same movement in another recording, of `n` of `total` repetitions. */
export interface OtherSession {
  n: number;
  total: number;
  mean: (number | null)[];
  sd: (number | null)[];
  differs: boolean[];
}

/** A channel over the repetitions of a cluster, and of those with the same name. */
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

/** Same recording, coarser (`detail` below 1) or finer. */
export interface TableAtDetail {
  detail: number;
  segments: Segment[];
}

/** What is drawn over a video, whose picture has so many pixels; see `kineme.web.film`. */
export interface Picture {
  width: number;
  height: number;
  keypoints: MotionHead;
}

/** A video of the recording, and when in it the recording starts, seconds. */
export interface Video {
  name: string;
  offset_s: number;
  picture?: Picture;
  address?: string;
}

/** Everything a page needs of one recording but the binary parts. */
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

/** What an edit made, already on the disk as `saved`. */
export interface Edited {
  revision: number;
  change: TableChange | null;
  segmentation: Segments | null;
  can_undo: boolean;
  can_redo: boolean;
  saved: string;
  notes: string[];
}

/** What people call a score, and what it measures. */
export interface ScoreMeaning {
  title: string;
  help: string;
}

/** Other result, and how well the shown one agrees with it. */
export interface Comparison {
  name: string;
  segmentation: Segments;
  scores: Record<string, number>;
  meanings?: Record<string, ScoreMeaning>;
  differences?: [number, number][];
}

/** A table that would take the place of the present one. */
export interface Preview {
  segmentation: Segments;
  corrections: number;
  names: number;
  lost: string[];
  details: number[];
  detail: number;
}

/** A table that was replaced; `edit` made it, null: it was found, or came from elsewhere. */
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

/** A repetition as a loop: the number of its row in the table, and how good it would be. */
export interface LoopRow {
  number: number;
  rank: number;
  cost: number;
  pose_m: number;
  slide_m_s: number | null;
  turn_deg: number;
  speed_m_s: number;
}

/** Repetitions of a recording as loops, those of a cluster together, the best first. */
export interface Loops {
  loops: LoopRow[];
}

/** A round of a loop as it would be written, its first frame again at the end. */
export interface PlayedLoop {
  motion: MotionHead;
  numbers: string;
  turn: number;
  x: number;
  z: number;
}

/** What the page of a folder shows of a segment table: its columns, and what people did. */
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

/** A recording of the folder and its table; null where nobody has segmented it yet. */
export interface FolderRecording {
  id: string;
  table: BriefTable | null;
}

/** Tables of all recordings of the folder, in the order of the list. */
export interface FolderTables {
  recordings: FolderRecording[];
}

/** What is being computed for a recording, and how much of that is done, 0 to 1. */
export interface Progress {
  stage: string;
  share: number | null;
}

/** Poses that are being estimated of the video `recording`, empty where none are. */
export interface PosesProgress {
  recording: string;
  name: string;
  share: number | null;
  pace: number;
  done: number;
  all: number;
  failed: string[];
}

/** Sent to every page when a recording's table changed or a file came. */
export interface Changed {
  recording: string;
  revision: number;
}

/** Why a request was refused, in one sentence; `people` are those one of whom is to be chosen. */
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

/** A preset, and those of its constants that the page offers to change. */
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

/** A file of the folder that an operation can use: a knowledge base, a label file. */
export interface FileChoice {
  id: string;
  name: string;
}

/** A format that segments can be written in, and the suffix of what is downloaded. */
export interface ExportFormat {
  name: string;
  suffix: string;
  help: string;
}

/** What the studio offers: the first message a page asks for. */
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

/** A new border at `frame`. */
export interface Split {
  kind: "split";
  level: Level;
  frame: number;
}

/** Make the segments of `[start_frame, stop_frame)` one. */
export interface Merge {
  kind: "merge";
  level: Level;
  start_frame: number;
  stop_frame: number;
}

/** Make the two segments that meet at `frame` one, like the longer of them. */
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

/** All segments of a cluster, of both levels, get a label. */
export interface NameCluster {
  kind: "name_cluster";
  cluster: number;
  label: string;
}

/** Put the segment that starts at `frame` into a cluster; -1: into none. */
export interface SetCluster {
  kind: "set_cluster";
  level: Level;
  frame: number;
  cluster: number;
}

/** Make the segment that starts at `frame` a transition in no cluster, or no transition. */
export interface SetKind {
  kind: "set_kind";
  level: Level;
  frame: number;
  to: Kind;
}

/** Segment the recording again by a preset; `keep` takes over corrections and names. */
export interface SegmentAgain {
  kind: "segment";
  preset: string;
  parameters: Record<string, number>;
  keep?: boolean;
  detail?: number;
}

/** Move the segments of a cluster into another one, `into`. */
export interface MergeClusters {
  kind: "merge_clusters";
  cluster: number;
  into: number;
}

/** Move the primitives of a cluster that start at `frames` into a new cluster. */
export interface SplitCluster {
  kind: "split_cluster";
  cluster: number;
  frames: number[];
}

/** Number the clusters in this order. */
export interface OrderClusters {
  kind: "order_clusters";
  order: number[];
}

/** Comment the segment that starts at `frame`; an empty comment removes it. */
export interface Remark {
  kind: "comment";
  level: Level;
  frame: number;
  text: string;
}

/** Mark the segments that start at `frames` as checked, or no longer. */
export interface Check {
  kind: "check";
  level: Level;
  frames: number[];
  checked: boolean;
}

/** Leave the primitives that start at `frames` out of all means, or count them again. */
export interface Exclude {
  kind: "exclude";
  frames: number[];
  excluded: boolean;
}

/** What a label file of the folder says becomes the table. */
export interface TakeLabels {
  kind: "take_labels";
  annotation: string;
}

/** A table that was replaced is the present one again. */
export interface Restore {
  kind: "restore";
  version: number;
}

/** Labels from a knowledge base of the folder. */
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

/** Redo the last edit that was undone. */
export interface Redo {
  kind: "redo";
}

export type ByHand = MoveBorder | Split | Merge | DeleteBorder | NameSegment | NameCluster | SetCluster | SetKind | MergeClusters | SplitCluster | OrderClusters | Remark | Check | Exclude;

/** Several edits, one after the other, which are one step of undo; all of them or none. */
export interface Together {
  kind: "together";
  edits: ByHand[];
}

/** An edit of the table as it was at `revision`. */
export interface EditRequest {
  revision: number;
  edit: Edit;
  name?: string;
}

/** A segmentation to look at, as `SegmentAgain` would make it. */
export interface PreviewRequest {
  preset: string;
  parameters: Record<string, number>;
  keep: boolean;
  detail?: number;
}

/** Labels that all recordings of the folder share, those on the keys 1 to 9 first. */
export interface LabelsRequest {
  labels: string[];
}

/** A knowledge base of that name, of the named primitives of recordings. */
export interface KnowledgeRequest {
  name: string;
  recordings: string[];
}

/** Segments by their rows in the table, as motion files; with `loops` made to close. */
export interface ClipsRequest {
  rows: number[];
  loops: boolean;
}

/** Where the recording starts in its reference video, seconds. */
export interface VideoRequest {
  offset_s: number;
}

/** Videos whose poses are to be estimated. */
export interface PosesRequest {
  recordings: string[];
}

/** How a recording is read: what is to be other than the file says, by its name. */
export interface ReadRequest {
  options: Record<string, string | number | boolean | string[]>;
  everybody?: boolean;
}

/** Another result to lay beside the shown one: a preset's, or a file's of the folder. */
export interface CompareRequest {
  preset?: string;
  annotation?: string;
}

/** Somebody who labelled so many recordings of the folder. */
export interface AnnotatorChoice {
  id: string;
  name: string;
  recordings: number;
}

/** Who is to be compared, by their ids. */
export interface AgreementRequest {
  annotators: string[];
}

/** How far two people agree, on the recordings that both labelled. */
export interface AgreementPair {
  annotators: [string, string];
  cohen_kappa: number | null;
  border_f1: number | null;
  recordings: number;
}

/** A span in seconds in which not all say the same, and what each says; empty is nothing. */
export interface Difference {
  start_s: number;
  stop_s: number;
  labels: string[];
}

/** How far those agree who labelled a recording, and where they differ. */
export interface RecordingAgreement {
  id: string;
  name: string;
  annotators: string[];
  fleiss_kappa: number | null;
  differences: Difference[];
}

/** How far people agree over the folder. */
export interface Agreement {
  annotators: string[];
  by_names: boolean;
  fleiss_kappa: number | null;
  pairs: AgreementPair[];
  recordings: RecordingAgreement[];
  failures: string[];
}

/** What somebody says of the open recording. */
export interface LabelLane {
  name: string;
  segmentation: Segments;
}

/** A recording of a library; `id` is what the studio opens it by, empty where it is gone. */
export interface LibraryRecording {
  recording: string;
  id: string;
  status: "as found" | "checked" | "corrected" | "gone";
  vocabulary: string;
  duration_s: number;
}

/** A cluster of a library, as `kineme.library.open_library.Cluster` tells it. */
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

/** A library: its recordings, its clusters, and what could not be read, with the reason. */
export interface LibraryState {
  folder: string;
  hours: number;
  recordings: LibraryRecording[];
  clusters: LibraryCluster[];
  failed: Record<string, string>;
  undo: string;
}

/** Where a recording is like an example; `label` is that of the cluster. */
export interface LibraryHit {
  recording: string;
  start_s: number;
  stop_s: number;
  distance: number;
  cluster: number;
  label: string;
  name?: string;
}

/** What a search found, the nearest first. */
export interface LibraryHits {
  hits: LibraryHit[];
}

/** How many hits have the name now, and which have not, with the reason. */
export interface NamedHits {
  named: number;
  left: string[];
}

/** A span of a recording to be drawn small: a motion, its numbers in base 64, or curves. */
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

/** What is searched for: any of the spans, or what is typical of a cluster; and unlike what. */
export interface SearchRequest {
  like: Span[];
  unlike: Span[];
  threshold: number;
  top: number;
  mirror: boolean;
  cluster?: number;
}

/** A name for the segments that hits show, each alone; an empty one takes it away. */
export interface CallHits {
  name: string;
  hits: Span[];
}

/** A name for a cluster of the library; an empty one takes it away. */
export interface CallCluster {
  kind: "name";
  cluster: number;
  name: string;
}

/** Others become part of a cluster of the library, which keeps its number and name. */
export interface JoinClusters {
  kind: "merge";
  cluster: number;
  others: number[];
}

/** What a cluster of the library has in some recordings becomes a cluster of its own. */
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

/** Saved tables take numbers and names of clusters from the library. */
export interface TablesRequest {
  names: boolean;
}

/** What a cluster of one recording is called now holds for it in all recordings. */
export interface CallEverywhere {
  recording: string;
  cluster: number;
  before: string;
  label: string;
}

/** How many tables were changed, how many clusters keep another name, and what failed, why. */
export interface TablesChanged {
  tables: number;
  others: number;
  left: string[];
}

/** An event of a stream; 0 or empty is what its kind does not have. */
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

/** What does not change in a stream: names of the curves, and joints that are connected. */
export interface LiveHead {
  channels: string[];
  sample_fps: number;
  bones: [number, number][];
}

/** What is new since the update before; the first one has a head. */
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
