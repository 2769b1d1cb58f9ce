// Types that several scripts share. The types of the HTTP interface are in api.d.ts.
declare namespace Front {
  // Elements: the name of an attribute that is a listener begins with "on" and says what its event is.
  type Child = Node | string | null | undefined | false;
  // deno-lint-ignore no-explicit-any
  type Attributes = Record<string, string | number | boolean | null | undefined | ((event: any) => unknown)>;

  // The sentences of a language by their English texts, and those that count by the text for one.
  type Dictionary = { tag: string; words: Record<string, string>; counts: Record<string, [string, string]> };
  type WordedValues = Record<string, string | number>;

  // A part of an exercise: its grids of cells, and their contents.
  type Column = { label: string; head: string; index?: string; spoken: string; quantity: Api.Quantity; offers?: string[]; help?: string };
  type Row = { label: string; spoken: string; head: string; quantity?: Api.Quantity; prefill?: string[]; isGiven?: boolean };
  type Grid = { title: string; look: "table" | "matrix" | "list"; columns: Column[]; rows: Row[]; hasNamedRows?: boolean; help?: string };
  type Layout = {
    grids: Grid[];
    choices: Record<string, string> | null;
    // The texts of a given table whose wrong cells are marked; the marks are the choice.
    marks?: string[][];
    answer(texts: string[], choice: string): unknown;
  };
  type PartState = { cells: string[]; choice: string };
  type Answers = { unit: Api.AngleUnit; parts: Record<string, PartState> };
  type Context = { exercise: string; angle_unit: Api.AngleUnit };

  // A cell: its place, how its text is read, and the owner that gets its events.
  // `offers` are names that the cell proposes; its text is no formula then.
  // Nobody can write into a given cell.
  type CellPlace = { id: string; label: string; spoken: string; offers?: string[]; isGiven?: boolean };
  type PartPlace = CellPlace & { part: string; quantity: Api.Quantity; row: RowView; prefill?: string };
  // What a cell holds, and what the form has filled in by itself.
  type Written = { text: string; prefill?: string };
  type Progress = { verdict: Api.Verdict | null; done: number; of: number };
  type RailPart = { part: Pick<Api.Part, "kind" | "title">; progress: Progress; jump(): void };
  type PlayPlace = CellPlace & { at: [number, number] };
  type Cell<Place extends CellPlace> = import("../static/shared/cell.js").Cell<Place>;
  type PartCell = Cell<PartPlace>;
  type PlayCell = Cell<PlayPlace>;
  type PartView = import("../static/student/part_view.js").PartView;
  type SlipMarks = import("../static/student/slip/slip_marks.js").SlipMarks;
  type RowView = import("../static/student/grid_view.js").RowView;
  type Reading = {
    text?: string;
    mathml?: string;
    notes?: Api.PreviewNote[];
    error?: { message: string; span?: [number, number]; suggestion?: string };
  };
  interface CellOwner<Place extends CellPlace> {
    entered(cell: Cell<Place>): void;
    pressed(event: KeyboardEvent, cell: Cell<Place>): void;
    pasted(event: ClipboardEvent, cell: Cell<Place>): void;
    beforeInput(event: InputEvent): void;
    typed(cell: Cell<Place>, before: string): void;
    changed(cell: Cell<Place>, told: HTMLElement[]): void;
    understood(cell: Cell<Place>): void;
    repaired(cell: Cell<Place>, suggestion: string): void;
  }
  type Change<Target, Value> = { target: Target; before: Value; after: Value };
  type Direction = "undo" | "redo";
  type PreviewService = {
    preview(body: Api.PreviewRequest): Promise<Api.Preview>;
    previews(body: Api.PreviewManyRequest): Promise<Api.PreviewManyResponse>;
    frames(body: Api.FramesRequest): Promise<Api.Frames>;
  };
  // What the bar of generated robots needs from its host.
  type PracticeHost = HTMLElement & {
    exercise: Api.Exercise;
    service: import("../static/shared/service.js").Service;
    failed(error: Error | null): void;
  };
  // What a part needs from its host.
  interface PartHost {
    exercise?: Api.Exercise;
    service: PreviewService;
    previewer: import("../static/student/previewer.js").Previewer;
    history: {
      note(changes: Change<PartCell, string>[], typed?: boolean): void;
      undo(): PartCell | null;
      redo(): PartCell | null;
    };
    context(): Context;
    announce(text: string, pause?: number): void;
    failed(error: Error | null): void;
    edited(): void;
    check(): void;
    // Where the answer can be changed.
    form?: import("../static/student/form/form.js").Form;
  }

  // What the form needs from the exercise.
  type FormHost = HTMLElement & {
    service: import("../static/shared/service.js").Service;
    exercise: Api.Exercise;
    texts: Answers;
    store: import("../static/shared/storage.js").Store;
    announce(text: string): void;
    edited(): void;
    check(): void;
  };

  // The assignments of a learner: the state of one exercise, an unconfirmed hand-in, and what an address names.
  type Own = { learner: string; course: Api.OwnCourse; assignment: Api.OwnAssignment; exercise: Api.OwnExercise };
  type Pending = { key: string; body: Api.HandInRequest };
  type Assigned = { path: string; exercise: string; attempt?: string };
  type Service = import("../static/shared/service.js").Service;
  // What a hand-in needs from the exercise.
  type HandInHost = HTMLElement & {
    service: import("../static/shared/service.js").Service;
    exercise: Api.Exercise;
    texts: Answers;
    answers: Record<string, unknown>;
    angleUnit: Api.AngleUnit;
    bar: import("../static/student/check_bar.js").CheckBar;
    form: import("../static/student/form/form.js").Form;
    received: HTMLElement;
    announce(text: string): void;
    edited(): void;
    save(): void;
    showReport(report: Api.Report, attempt?: string): void;
  };

  // A place of a message, and the message as it is shown.
  type Topic = { row?: string; cell?: string };
  type Told = { element: HTMLElement; feedback: Api.Feedback; place: Topic };
  // A wrong cell or mark that has the focus after Check, its name, and its first message.
  type Slip = { field: HTMLElement; name: string; message: Element | null };

  // What the hints at the report of an attempt cost: shares of the points of the exercise.
  type HintPrices = { attempt: string; prices: number[]; taken: Api.TakenHint[]; points: number };

  // What hints need from the exercise.
  type HintHost = HTMLElement & {
    handIn: import("../static/student/handin/hand_in.js").HandIn | null;
    bar: import("../static/student/check_bar.js").CheckBar;
    service: import("../static/shared/service.js").Service;
    exercise: Api.Exercise;
    answers: Record<string, unknown>;
    angleUnit: Api.AngleUnit;
    colours: import("../static/student/embedding/page_colours.js").PageColours;
    announce(text: string): void;
  };

  // The 3D view: pictures from the service, drawn by three.js or shown as a drawing.
  type Frame = number[][];
  type Picture = {
    frames: Frame[] | null;
    values?: number[][] | null;
    mechanism: Api.DrawnConfiguration | null;
    placed?: Frame[] | null;
  };
  type Subject = {
    kinds: Api.JointKind[];
    rowKinds: (Api.JointKind | null)[];
    convention: Api.Convention;
    size: number;
    azimuth: number;
    elevation: number;
    solid: boolean;
    beside(): boolean;
    robot(): boolean;
    shown(i: number): boolean;
    labels: string[];
    given(): boolean;
    placed: string[];
    shownPlaced(): boolean;
    gap(picture: Picture): Gap | null;
    row(shapes: Shapes, size: number, stage: HTMLElement): RowShape | null;
    shownRow(picture: Picture): ShownRow | null;
  };
  type Gap = import("../static/robot/frames/gap.js").Gap;
  // A row on its way: `at` moves are done. If it is lit, only the current move is shown.
  type ShownRow = {
    start: Frame;
    moves: Move[];
    at: number;
    current: number;
    isLit: boolean;
    text: string;
    gap: Gap | null;
  };
  type Move = import("../static/robot/rows/row_moves.js").Move;
  type RowShape = import("../static/robot/rows/row_shape.js").RowShape;
  type RowShapeClass = typeof import("../static/robot/rows/row_shape.js").RowShape;
  type FrameCell = "axis" | "z" | "origin_x" | "origin_y" | "origin_z" | "x";
  type FrameStep = "z" | "origin" | "x";
  // A dot or the end of an arrow that may be clicked, and the cells that it writes.
  type PlaceMark = { at: number[]; from?: number[]; texts: [FrameCell, string][]; isChosen: boolean; told: string };
  type AxisMark = { joint: string; ends: number[][] };
  type ShownValues = { symbols: Record<string, number>; joints: number[] };
  // A point as texts, and as sums: the factor of each symbol in each coordinate.
  type NamedPlace = { texts: string[]; sums: number[][] };
  // What is offered with all joint variables 0. `slid` and `directions` are for each joint axis.
  type HomeOffers = {
    axes: number[][];
    names: string[];
    places: NamedPlace[];
    slid: NamedPlace[][];
    directions: number[][][];
  };
  // The motion of the link of each frame since then, and the picture of which it is.
  type LinkMotions = {
    picture: Pick<Api.DrawnConfiguration, "centres" | "axes">;
    symbols: Record<string, number>;
    motions: Frame[];
  };
  type FrameClicks = import("../static/robot/placing/frame_clicks.js").FrameClicks;
  type RowPlayer = import("../static/robot/rows/row_player.js").RowPlayer;
  type RowHost = { host: ViewHost; isFlat(): boolean; draw(): void; build(): void };
  type LabelRoom = import("../static/robot/frames/label_places.js").Room;
  type DrawSvg = (theme: Api.Theme) => Promise<string | null | undefined>;
  type RobotView = import("../static/robot/robot_view.js").RobotView;
  type RobotFigure = import("../static/student/robot_figure.js").RobotFigure;
  type Stage = import("../static/robot/stage.js").Stage;
  type RobotScene = import("../static/robot/scene.js").RobotScene;
  type FlatScene = import("../static/robot/flat_scene.js").FlatScene;
  type Shapes = import("../static/robot/shapes.js").Shapes;
  type Scene = import("../static/vendor/three-0.185.1.module.min.js").Scene;
  type Camera = import("../static/vendor/three-0.185.1.module.min.js").PerspectiveCamera;
  type Vector2 = import("../static/vendor/three-0.185.1.module.min.js").Vector2;
  type Vector3 = import("../static/vendor/three-0.185.1.module.min.js").Vector3;
  type Palette = typeof import("../static/robot/palette.js").LIGHT;
  // A cell of the table that is drawn.
  type TableCell = { input: HTMLInputElement; element: HTMLElement; place: { label: string } };
  type ViewHost = {
    service: import("../static/shared/service.js").Service;
    body(): Api.FramesRequest | null;
    descriptions?: Record<string, string>;
    unit?: string;
    cells?(): TableCell[][];
    // The part that asks for frames, if there is one.
    placing?(): PartView | undefined;
    announce(text: string): void;
    answered?(answer: Api.Frames, isKept: boolean): void;
    moved?(picture: Picture): void;
  };

  // Free play.
  type PlayRow = { kind: string; cells: string[] };
  type Robot = { convention: Api.Convention; unit: Api.AngleUnit; rows: PlayRow[] };

  // The pages of recorded attempts.
  type Filter = {
    exercise?: string;
    learner?: string;
    since?: string;
    until?: string;
    course?: string;
    assignment?: string;
  };
  type FilterField = HTMLInputElement | HTMLSelectElement;
  // A file in an archive: the place of its bytes, and true if they are packed.
  type ZipEntry = {
    from: number;
    size: number;
    packed: boolean;
    isReadable: boolean;
    local: number;
    head: number;
    headEnd: number;
  };
}
