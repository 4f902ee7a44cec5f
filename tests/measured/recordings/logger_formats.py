"""Recordings as other people's benches write them, each with its truth: what every column is, in units of memory.

One invented test of a machine: at rest for 100 s, then 9 A and 1500 rpm. Letters stand for its signals:
t time (s), I current (A), n speed (rpm), M torque (N m), P power of the losses (W), U voltage (V), q flow (l/min),
W winding, H housing, B bearing, A room (degC); lower-case x, y, z are columns that no model reads; e is empty.
"""

from dataclasses import dataclass, field
from datetime import datetime, timedelta
from functools import partial

import numpy as np
import openpyxl

ROWS = 90
BEGUN = datetime(2026, 3, 28, 12, 0, 10)
GERMAN = ["Jan", "Feb", "Mrz", "Apr", "Mai", "Jun", "Jul", "Aug", "Sep", "Okt", "Nov", "Dez"]


def signals(step_s: float, rows: int = ROWS) -> dict[str, np.ndarray]:
    """Letter -> readings (rows,)"""
    k = np.arange(float(rows))
    on = (k >= 20).astype(float)
    rise = 1.0 - np.exp(-np.maximum(k - 20.0, 0.0) / 30.0)
    return {
        "t": step_s * k,
        "I": 9.0 * on,
        "n": 1500.0 * on,
        "M": 1.5 * on,
        "P": 120.0 * on,
        "U": 48.0 - on,
        "q": 6.0 + 0.0 * k,
        "W": 24.0 + 60.0 * rise,
        "H": 23.5 + 30.0 * rise,
        "B": 23.0 + 20.0 * rise,
        "A": 22.0 + 0.1 * np.sin(k / 9.0),
    }


NAMES = {
    "I": "Current [A]",
    "n": "Speed [rpm]",
    "W": "T_winding [°C]",
    "H": "T_housing [°C]",
    "B": "T_bearing [°C]",
    "A": "T_ambient [°C]",
    "P": "P_loss [W]",
    "M": "Torque [Nm]",
    "t": "Time [s]",
}


@dataclass(frozen=True)
class Format:
    """A text format.  columns : letter of each column's signal;  names, units : of the header, between semicolons

    stamp : row -> cell of the clock;  scale : letter -> (factor, offset) from the unit of memory into that of the file
    cells : letter -> row -> cell of a column that is not a number;  doubt : words that must be said
    without : letters that are left out though they have a meaning;  switches : columns that are on and off
    """

    columns: str
    names: str | None = None
    sep: str = ","
    point: str = "."
    step_s: float = 5.0
    stamp: object = None
    before: str = ""
    units: str = ""
    after: str = ""
    encoding: str = "utf-8"
    scale: dict = field(default_factory=dict)
    cells: dict = field(default_factory=dict)
    doubt: str = ""
    ending: str = "\n"
    quote: bool = False
    name: str = "a.csv"
    row: object = None
    digits: int = 2
    switches: tuple[str, ...] = ()

    def header(self) -> list[str]:
        return [NAMES[c] for c in self.columns] if self.names is None else self.names.split(";") if self.names else []

    def content(self) -> bytes:
        values = signals(self.step_s)
        lines = []
        for k in range(ROWS):
            cells = [self._cell(c, k, values) for c in self.columns]
            lines.append(self.row(cells) if self.row else self.sep.join(f'"{c}"' if self.quote else c for c in cells))
        head = [self.sep.join(f'"{n}"' if self.quote else n for n in self.header())] if self.header() else []
        units = [self.units.replace(";", self.sep)] if self.units else []
        text = self.before + "\n".join([*head, *units, *lines]) + "\n" + self.after
        return text.replace("\n", self.ending).encode(self.encoding)

    def _cell(self, c: str, k: int, values: dict) -> str:
        if c in self.cells:
            return str(self.cells[c](k))
        if c == "t":
            return self.stamp(k) if self.stamp else f"{values['t'][k]:g}".replace(".", self.point)
        if c not in values:
            return "" if c == "e" else str(k % 7)
        factor, offset = self.scale.get(c, (1.0, 0.0))
        return f"{values[c][k] * factor + offset:.{self.digits}f}".replace(".", self.point)


semicolons = partial(Format, sep=";", point=",")


def at(form: str, step_s: float = 5.0):
    """A stamp by strftime."""
    return lambda k: (BEGUN + timedelta(seconds=step_s * k)).strftime(form)


def german(k: int) -> str:
    now = BEGUN + timedelta(seconds=5 * k)
    return f"{now.day}. {GERMAN[now.month - 1]} {now.year} {now:%H:%M:%S}"


def turkish(now: datetime) -> str:
    return f"{(now.hour - 1) % 12 + 1:02d}:{now:%M:%S} {'ÖÖ' if now.hour < 12 else 'ÖS'}"


def beside(letter: str, sign: str):
    """The largest or the least of a signal since the row before."""
    return lambda k: f"{signals(5.0)[letter][k] + float(sign + '0.05'):.2f}"


def korean(now: datetime) -> str:
    return f"{now:%Y-%m-%d} {'오전' if now.hour < 12 else '오후'} {(now.hour - 1) % 12 + 1}:{now:%M:%S}"


def workbook(path, **sheets):
    """A workbook of the rows of every sheet."""
    book = openpyxl.Workbook()
    book.remove(book.active)
    for name, rows in sheets.items():
        page = book.create_sheet(name)
        for row in rows:
            page.append(row)
    book.save(path)
    return path


IWA, PWA = (";".join(NAMES[c] for c in letters) for letters in ("IWA", "PWA"))
UNIX, COUNT = 1774699210, {"x": lambda k: k + 1}
K, F, RADS = (1.0, 273.15), (1.8, 32.0), (np.pi / 30, 0.0)
STEEL = {"W": K, "H": K, "A": K}
FAHRENHEIT = {"W": F, "H": F, "A": F}
LVM = """LabVIEW Measurement	
Writer_Version	2
Reader_Version	2
Separator	Tab
Decimal_Separator	.
Multi_Headings	No
X_Columns	One
Time_Pref	Relative
Operator	somebody
Date	2026/03/28
Time	12:00:10.5
***End_of_Header***	
	
Channels	3			
Samples	90	90	90	
Date	2026/03/28	2026/03/28	2026/03/28	
Time	12:00:10.5	12:00:10.5	12:00:10.5	
Y_Unit_Label	A	°C	°C	
X_Dimension	Time	Time	Time	
X0	0.0	0.0	0.0	
Delta_X	5.0	5.0	5.0	
***End_of_Header***				
"""
CATMAN = """catman export
Data from: bench 4;;
Channels: 5;;

"""
INCA = "ETASAsciiItemFile\trecord,Group 1\tdecimalSeparator=.\ntabulator=\\t\nsampleCount\t90\n"
YOKOGAWA = '"Model","GM10"\n"Serial No.","S5T1"\n"Start Time","2026/03/28 12:00:10"\n"Sampling Interval","5 s"\n\n'
PICO = ",,,\n"
KEYSIGHT = "Name:,bench\nOwner:,lab\nComments:,\n\nTotal Scans:,90\n\n"

FORMATS: dict[str, Format] = {
    "plain": Format("tInWHA"),
    "german, semicolons and decimal commas": semicolons(
        "tInWHA",
        "Zeit;Strom;Drehzahl;T_Wicklung;T_Gehäuse;T_Umgebung",
        units="s;A;1/min;°C;°C;°C",
        encoding="cp1252",
        ending="\r\n",
    ),
    "german, short names": semicolons("tIWBHA", "Zeit [s];I_Ph [A];T_Wickl_V;T_Lager_AS;T_Geh;T_Umg"),
    "german, compounds": semicolons(
        "tInWHA",
        (
            "Messzeit [s];Phasenstrom [A];Motordrehzahl [U/min];Wicklungstemperatur [°C];"
            "Gehäusetemperatur [°C];Raumtemperatur [°C]"
        ),
    ),
    "french": semicolons(
        "tInWBA",
        (
            "Temps (s);Courant (A);Vitesse (tr/min);Température bobinage (°C);"
            "Température palier (°C);Température ambiante (°C)"
        ),
        encoding="latin-1",
    ),
    "italian": semicolons(
        "tIMWHA",
        (
            "Tempo [s];Corrente [A];Coppia [Nm];Temperatura avvolgimento [°C];"
            "Temperatura carcassa [°C];Temperatura ambiente [°C]"
        ),
    ),
    "spanish": Format(
        "tInWBA",
        (
            "Tiempo (s);Corriente (A);Velocidad (rpm);Temperatura devanado (°C);"
            "Temperatura cojinete (°C);Temperatura ambiente (°C)"
        ),
        "\t",
        ",",
    ),
    "a row of units": Format("tInWA", "time;current;speed;T winding;T ambient", units="s;A;rpm;degC;degC"),
    "units after slashes": Format("tIWA", "t / s;I / A;T_winding / K;T_amb / K", "\t", scale=STEEL),
    "units after underscores": Format("tInWA", "time_s;current_A;speed_rpm;T_winding_degC;T_ambient_degC"),
    "units in angles and braces": Format("tIWA", "t <s>;I <A>;winding {°C};ambient {°C}", "|"),
    "the ordinal sign": Format("tIWA", "Time (s);Current (A);Motor winding (ºF);Room (ºF)", scale=FAHRENHEIT),
    "UTF-16": Format("tIWA", sep="\t", encoding="utf-16"),
    "UTF-16 without a mark": Format("tIWA", sep="\t", encoding="utf-16-le"),
    "UTF-8 with a mark": Format("tIWA", encoding="utf-8-sig"),
    "DOS letters": semicolons("tIWHA", "Zeit [s];I [A];Wicklung [°C];Gehäuse [°C];Raum [°C]", encoding="cp850"),
    "Macintosh letters": Format("tIWA", encoding="mac_roman"),
    "japanese": Format("tIWA", "時間 [s];電流 [A];巻線温度 [℃];周囲温度 [℃]", encoding="cp932"),
    "chinese": Format("tIWA", "时间(s);电流(A);绕组温度(℃);环境温度(℃)", encoding="gb18030"),
    "ISO": Format("tIWA", f"timestamp;{IWA}", stamp=at("%Y-%m-%dT%H:%M:%S")),
    "ISO with a zone": Format("tIWA", f"timestamp;{IWA}", stamp=at("%Y-%m-%dT%H:%M:%S.000+02:00")),
    "compact ISO": Format("tIWA", f"stamp;{IWA}", stamp=at("%Y%m%dT%H%M%S")),
    "compact digits": Format("tIWA", f"Time;{IWA}", stamp=at("%Y%m%d%H%M%S")),
    "28-Mar-2026": Format("tIWA", f"Time;{IWA}", stamp=at("%d-%b-%Y %H:%M:%S")),
    "a weekday": Format("tIWA", f"Time;{IWA}", stamp=at("%a %b %d %H:%M:%S %Y")),
    "a german month": Format("tIWA", f"Zeit;{IWA}", ";", stamp=german),
    "german dates": semicolons("tIWA", f"Datum/Zeit;{IWA}", stamp=at("%d.%m.%Y %H:%M:%S,50")),
    "american dates": Format("tIWA", f"Date/Time;{IWA}", stamp=at("%m/%d/%Y %I:%M:%S %p")),
    "spanish halves of a day": semicolons(
        "tIWA", f"Fecha;{IWA}", stamp=lambda k: at("%d/%m/%Y %I:%M:%S")(k) + " p. m."
    ),
    "date and time apart": semicolons(
        "xtIWA", "Datum;Uhrzeit;I [A];T_Wicklung [°C];T_Raum [°C]", cells={"x": at("%d.%m.%Y")}, stamp=at("%H:%M:%S")
    ),
    "over midnight": Format(
        "tIWA", f"Time;{IWA}", stamp=lambda k: f"{datetime(2026, 1, 1, 23, 58) + timedelta(seconds=5 * k):%H:%M:%S}"
    ),
    "hours and minutes": Format("tIWA", f"Time;{IWA}", stamp=at("%H:%M", 60), step_s=60, doubt="hours:minutes"),
    "minutes and tenths": semicolons(
        "tIWA", f"Time;{IWA}", step_s=0.5, stamp=lambda k: f"{k // 120}:{0.5 * (k % 120):04.1f}".replace(".", ",")
    ),
    "several rows a minute": Format("tIWA", f"Time;{IWA}", stamp=lambda k: at("%H:%M")(k - 2), doubt="share each time"),
    "spans": Format("tIWA", f"elapsed;{IWA}", stamp=lambda k: f"PT{5 * k // 60}M{5 * k % 60}S"),
    "days and hours": Format("tIWA", f"elapsed;{IWA}", stamp=lambda k: f"0 days {timedelta(seconds=5 * k)!s:0>8}"),
    "dates alone": Format("tPWA", f"date;{PWA}", step_s=86400, stamp=at("%Y-%m-%d", 86400)),
    "milliseconds": Format("tIWA", f"time_ms;{IWA}", stamp=lambda k: str(5000 * k)),
    "milliseconds unsaid": Format(
        "tIWA", f"time;{IWA}", stamp=lambda k: str(250 * k), step_s=0.25, doubt="ms are assumed"
    ),
    "nanoseconds since 1970": Format(
        "tIWAx",
        "time;I [A];T1 winding;T2 room;time_T1",
        stamp=lambda k: str((UNIX + 5 * k) * 10**9),
        cells={"x": lambda k: (UNIX + 5 * k) * 10**9 + 1000},
    ),
    "ticks": Format("tIWA", f"Ticks time;{IWA}", stamp=lambda k: str(639000000000000000 + k * 50000000), doubt="ticks"),
    "days of a spreadsheet": Format("tIWA", f"Time;{IWA}", stamp=lambda k: f"{46109.5 + k / 17280:.9f}"),
    "parts of a day": Format("tIWA", f"Time;{IWA}", stamp=lambda k: f"{0.5 + k / 17280:.9f}", doubt="parts of a day"),
    "hours": Format("tPWA", f"Time (h);{PWA}", step_s=36, stamp=lambda k: f"{k / 100:.2f}"),
    "a summer time that ends": Format(
        "tIWA",
        f"Time;{IWA}",
        step_s=60,
        doubt="end of summer time",
        stamp=lambda k: f"{datetime(2026, 10, 25, 2, 20) + timedelta(minutes=k - 60 * (k >= 40)):%d.%m.%Y %H:%M:%S}",
    ),
    "LabVIEW": Format("tIWAe", "X_Value;Current;T winding;T ambient;Comment", "\t", before=LVM, name="a.lvm"),
    "no header": Format("tWH", "", "\t", doubt="no header", name="a.txt"),
    "Catman": Format(
        "tIWA",
        "Zeit  1 - Standard Messrate [s];MX840_CH 1 Strom [A];MX1609 Wicklung [°C];MX1609 Umgebung [°C]",
        "\t",
        ",",
        before=CATMAN,
    ),
    "Yokogawa": Format(
        "xtIWH",
        "Date;Time;CH001;CH002;CH003",
        before=YOKOGAWA,
        cells={"x": at("%Y/%m/%d")},
        stamp=at("%H:%M:%S"),
        units=";;A;C;C",
    ),
    "Graphtec": Format(
        "xtyIWA",
        "Number;Date&Time;ms;CH1 I;CH2 winding;CH3 room",
        stamp=at("%Y/%m/%d %H:%M:%S"),
        units="NO.;Time;ms;A;degC;degC",
        cells=COUNT | {"y": lambda k: 0},
    ),
    "Keysight": Format(
        "xtWyAz",
        "Scan;Time;101 winding (C);Alarm 101;102 ambient (C);Alarm 102",
        before=KEYSIGHT,
        stamp=at("%m/%d/%Y %H:%M:%S:250"),
        cells=COUNT | {"y": lambda k: 0, "z": lambda k: 0},
    ),
    "Pico TC-08": Format(
        "tWHA", ";winding Ave. (°C);housing Ave. (°C);ambient Ave. (°C)", stamp=at("%Y-%m-%dT%H:%M:%S+00:00")
    ),
    "Fluke": Format(
        "xtWA",
        "Reading;Sample Time;Motor winding °C;Room °C",
        stamp=at("%m/%d/%Y %I:%M:%S %p"),
        cells=COUNT,
        row=lambda cells: ",".join([*cells[:2], f"{cells[2]} °C", f"{cells[3]} °C"]),
    ),
    "dSPACE": Format(
        "tIxWA",
        "time;Model Root/i_phase_A;Model Root/state;Model Root/theta_winding_degC;Model Root/theta_ambient_degC",
        cells={"x": lambda k: 3},
    ),
    "INCA": Format("tnWA", "time;nMot;tWndg;tAmb", "\t", before=INCA, units="s;rpm;degC;degC"),
    "Arduino": Format("tWA", "", " ", name="serial.txt", row=lambda c: f"t: {c[0]}, T winding: {c[1]}, T room: {c[2]}"),
    "a serial monitor": Format(
        "tIWA",
        "",
        stamp=at("%H:%M:%S.000"),
        name="serial.txt",
        row=lambda c: f"{c[0]} -> I={c[1]} winding={c[2]} room={c[3]}",
    ),
    "a BMS": Format(
        "tUIxyWA", "Time [s];Pack voltage [V];Pack current [A];SOC [%];Fault;Cell temp max [°C];Ambient temp [°C]"
    ),
    "a cycler": Format(
        "ztxIUyWAe",
        "Exclude;Time(s);Cycle;Current(A);Voltage(V);Capacity(Ah);Temperature cell(C);Temperature room(C);Data",
        cells={"z": lambda k: "No", "x": lambda k: 1, "y": lambda k: -0.01 * k},
        row=lambda c: ",".join(c) + " ,",
    ),
    "a robot": Format(
        "txnIWHA",
        "time [s];a1 angle [rad];a1 speed [rad/s];a1 phase [A];a1 winding temp [C];housing temp [C];room temp [C]",
        scale={"n": RADS},
    ),
    "an espresso machine": Format(
        "txPWA", "Elapsed (s);Pressure (bar);Heater power (W);Boiler temp (°C);Room temp (°C)"
    ),
    "a building": Format(
        "tPWHA", ";P_heat;Ti;Th;Te", step_s=3600, stamp=at("%Y-%m-%d %H:%M:%S+00:00", 3600), doubt="by its letters"
    ),
    "a counter called t": Format(
        "zxPHA",
        "date;t;P_heat;yTi1;Ta",
        step_s=3600,
        cells={"x": lambda k: 2750 + k, "z": at("%Y-%m-%d %H:%M:%S", 3600)},
        doubt="by its letters",
    ),
    "an angle": Format("tIxWA", "t;i_q [A];theta_e;theta_winding;theta_amb"),
    "a robot's state": Format(
        "tnMIWA",
        "stamp;j1_vel [rad/s];j1_effort [Nm];j1_current [A];j1_winding_temp;room_temp",
        ";",
        scale={"n": RADS},
        stamp=lambda k: f"{UNIX + 5 * k}.25",
        digits=4,
    ),
    "one meter": Format(
        "xtWy",
        "Index;Timestamp;Reading;Units",
        stamp=at("%m/%d/%Y %H:%M:%S.000000"),
        cells={"y": lambda k: "Celsius"},
        before="Model,DMM\nSample Interval,5.000\n,,\n",
    ),
    "signs apart": Format(
        "tWA", "Time [s];CH1 winding [degC];CH2 room [degC]", row=lambda c: f"{c[0]},+ {c[1]},+ {c[2]}"
    ),
    "three phases": semicolons("tWWWI", "Zeit [s];T1_Wicklung_U;T2_Wicklung_V;T3_Wicklung_W;I_eff [A]"),
    "groups over names": Format("tWIA", "s;Temp [°C];Strom [A];Temp [°C]", ";", before=";Motor;;Umwelt\n"),
    "points in times": semicolons("tIWA", f"Data e ora;{IWA}", stamp=at("%d/%m/%Y %H.%M.%S")),
    "degrees that were lost": Format("tIWA", "Time [s];I [A];winding [?C];room [Â°C]"),
    "names over two lines": Format("tIWA", "Time\n[s];I\n[A];winding\n[°C];room\n[°C]", quote=True),
    "a name for dates over degrees": Format("tWAI", "Time [s];Data winding [°C];Data room [°C];I [A]"),
    "a logger of buildings": Format(
        "xtWAIyz",
        (
            "#;Date Time, GMT+01:00;Temp, °F (LGR S/N: 1, SEN S/N: 2, LBL: winding);"
            "Temp, °F (LGR S/N: 1, SEN S/N: 3, LBL: ambient);Current, A (LGR S/N: 1, SEN S/N: 4);"
            "Host Connected (LGR S/N: 1);End Of File (LGR S/N: 1)"
        ),
        before='"Plot Title: pump"\n',
        stamp=at("%m/%d/%y %I:%M:%S %p"),
        scale=FAHRENHEIT,
        quote=True,
        cells={"x": lambda k: k + 1, "y": lambda k: "Logged" * (k == 0), "z": lambda k: "Logged" * (k == ROWS - 1)},
    ),
    "a controller's scope": Format(
        "xIyWzA",
        "Name;fCurrent;Name;fMotorTemp;Name;fAmbientTemp",
        "\t",
        before="File\tC:/scope/a\nStart\t134190792100000000\n\n",
        units=(
            "Data-Type;LREAL;Data-Type;LREAL;Data-Type;LREAL\n"
            "SampleTime[ms]\t5000\tSampleTime[ms]\t5000\tSampleTime[ms]\t5000\nUnit\tA\tUnit\t°C\tUnit\t°C\n"
        ),
        cells={c: lambda k: 5000 * k for c in "xyz"},
        doubt="rows 5 s apart as the lines before its header say",
    ),
    "what channels are in a row of remarks": Format(
        "tWHAI",
        "Time;U1-1[C];U1-2[C];U1-3[C];U2-1[A]",
        before='"Mode","Tc K","Tc K","Tc K","Voltage"\n"Comment","Winding","Housing","Room","Shunt"\n'
        '"Scaling","OFF","OFF","OFF","ON"\n"Ratio","1","1","1","10"\n',
    ),
    "days since year 0": Format("tIWA", "datenum;i_rms;T_wdg;T_amb", stamp=lambda k: f"{740069.5 + k / 17280:.9f}"),
    "polish": semicolons("tIWBA", "Czas [s];Prąd [A];Temp. uzwojenia [°C];Temp. łożyska [°C];Temp. otoczenia [°C]"),
    "a speed in dutch": semicolons("tInWA", "Tijd;Stroom (A);Toerental (omw/min);Wikkeling (°C);Omgeving (°C)"),
    "a speed controller": Format(
        "tUWnI",
        "ms_today;input_voltage;temp_motor;motor_rpm;current_motor",
        ";",
        stamp=lambda k: str(43_210_000 + 5000 * k),
    ),
    "a flight log": Format("tnUIxW", "timestamp;RPM;Volt;Curr;TempEsc;MotTemp", stamp=lambda k: f"{UNIX + 5 * k}.0"),
    "a code among currents": Format(
        "tIWA", cells={"I": lambda k: -9999 if k == 60 else f"{signals(5.0)['I'][k]:.2f}"}, doubt="a logger's code?"
    ),
    "LabVIEW without times": Format(
        "eIWAe",
        ";Current [A];Winding [°C];Room [°C];Comment",
        "\t",
        step_s=0.5,
        name="a.lvm",
        before=LVM.replace("X_Columns\tOne", "X_Columns\tNo").replace("5.0", "0.5"),
        doubt="as the lines before its header say",
    ),
    "hours, minutes and seconds": Format("tIWA", f"Elapsed;{IWA}", stamp=lambda k: f"0h {5 * k // 60}m {5 * k % 60}s"),
    "dutch": semicolons("tIWA", "Tijd;Stroom;Temperatuur wikkeling;Omgevingstemperatuur"),
    "greek letters": Format(
        "tMnWxA", "t [s];τ [Nm];ω [rad/s];ϑ winding [°C];Δϑ [K];ϑ room [°C]", scale={"n": RADS}, digits=3
    ),
    "an object on every line": Format(
        "tIWA", "", row=lambda c: f'{{"t": {c[0]}, "I": {c[1]}, "winding": {c[2]}, "room": {c[3]}}}'
    ),
    "channels with numbers": semicolons("tIWH", "Channel 1;Channel 2;Channel 3;Channel 4", units="s;A;°C;°C"),
    "a cycler that counts": Format(
        "xytIUWA",
        "Record ID;Step;Test Time;Current/mA;Voltage/V;Aux Temp 1/C;Amb Temp 2/C",
        cells=COUNT,
        stamp=lambda k: f"00:{5 * k // 60:02d}:{5 * k % 60:02d}.000",
        scale={"I": (1e3, 0)},
    ),
    "a cycler with a control": Format(
        "txUIW", "time/s;control/V/mA;Ecell/V;I/mA;Temperature/°C", cells={"x": lambda k: 1}, scale={"I": (1e3, 0)}
    ),
    "an incubator": Format(
        "tPWxA", "Date Time;Heater [W];T_inside [°C];Humidity [%];T_room [°C]", stamp=at("%Y/%m/%d %H:%M:%S")
    ),
    "a drive with axes": Format("tIInWA", "time_s;i_d;i_q;n_mot;T_winding;T_ambient"),
    "CAN": Format(
        "tIxyWA",
        (
            "time [s];Inverter.PhaseCurrent [A];Inverter.Mode;Inverter.FaultCode;"
            "Motor.WindingTemp [degC];Motor.AmbientTemp [degC]"
        ),
    ),
    "text beside readings": Format(
        "txIWA", "Time [s];Operator;I [A];T_winding [°C];T_room [°C]", cells={"x": lambda k: "Müller"}
    ),
    "an almost empty column": Format(
        "tIWAx", "Time [s];I [A];T_winding [°C];T_room [°C];Remarks", cells={"x": lambda k: "fan on" if k == 40 else ""}
    ),
    "quoted cells": Format("tIWA", point=",", quote=True),
    "blanks": Format("tIWA", "t[s];I[A];T_winding[C];T_amb[C]", " "),
    "a comment sign before the names": Format("tIWA", "# time_s;current_A;T_winding;T_ambient", "\t"),
    "thousands": semicolons(
        "tInWA",
        "Zeit [s];I [A];n [1/min];T_Wickl [°C];T_Raum [°C]",
        cells={"n": lambda k: f"{1.5 * (k >= 20):.3f}" if k >= 20 else "0"},
    ),
    "a code now and then": Format("tIWA", cells={"W": lambda k: "9999" if k == 50 else f"{signals(5.0)['W'][k]:.2f}"}),
    "kelvin under degC": Format("tIWHA", scale=STEEL, doubt="K by its values"),
    "Fahrenheit unsaid": Format(
        "tIWA", "time_s;current_A;T_winding;T_room", scale=FAHRENHEIT, doubt="degF by its values"
    ),
    "a rise beside the temperature": Format("tIxWA", "Time [s];I [A];dT winding [K];T winding [°C];T room [°C]"),
    "words at the end": Format("tIWA", after="End of data\nOperator: somebody\n"),
    "a second name over each": Format("tIWA", "Time [s];I [A];Temp [°C];Temp [°C]", before=",,winding,ambient\n"),
    "names for statistics programs": Format("xtIWA", "time_s;I_A;T_winding;T_room", " ", cells=COUNT),
    "labels alone over the readings": Format(
        "etIWA",
        "Channel name:;Time 1;I_rms;Winding DE;Ambient",
        "\t",
        ",",
        before="bench 4\tAP 5.5\n",
        units="Unit:;s;A;°C;°C\nComment:\t\t\t\t",
    ),
    "remarks beside a clock": Format(
        "xtWHI",
        "Date;Time;U1-1[C];U1-2[C];U2-1[A]",
        before='"Trigger","\'26-03-28 12:00:10"\n"CH","U1-1","U1-2","U2-1"\n"Comment","Winding","Frame","Shunt"\n',
        cells={"x": at("'%y-%m-%d")},
        stamp=at("%H:%M:%S.0"),
    ),
    "units before names": semicolons(
        "xtWHI",
        "DATUM:;ZEIT:;M00: °C  Wicklung;°C Gehaeuse;M10: A  Strom",
        cells={"x": at("%d.%m.%y")},
        stamp=at("%H:%M:%S"),
        encoding="cp1252",
    ),
    "names and units between bars": Format(
        "tWAI",
        '"Interval"|"ms"|0|5;"MotorTemp"|"C"|0|5;"Ambient"|"C"|0|5;"Current"|"A"|0|5',
        stamp=lambda k: str(5000 * k),
    ),
    "a phone": Format(
        "tyWAI",
        "GPS Time;Device Time;Motor(°C);Ambient(°C);Current(A)",
        stamp=at("%a %b %d %H:%M:%S GMT+01:00 2026"),
        cells={"y": at("%d-%b-%Y %H:%M:%S.000")},
    ),
    "objects in an object": Format(
        "tIWA",
        "",
        row=lambda c: (
            f'{{"ts": {UNIX + 5 * int(float(c[0])) // 5}, "current_a": {c[1]}, "temps": '
            f'{{"winding": {c[2]}, "ambient": {c[3]}}}}}'
        ),
    ),
    "states without a unit": Format(
        "tIWAxz",
        "time;iPh;tWndg;tAmb;stFlt;xBrkOn",
        "\t",
        units="s;A;deg C;deg C;-;",
        cells={"z": lambda k: "TRUE" if k > 9 else "FALSE"},
        switches=("xBrkOn",),
    ),
    "turns in danish": semicolons("tnWA", "Tid;Omdrejningstal (o/min);Vikling (°C);T_a (°C)"),
    "microseconds unsaid": Format("tIWA", f"Timestamp;{IWA}", stamp=lambda k: str(5000000 * k), doubt="us are assumed"),
    "a header that comes again": Format(
        "tIWA",
        row=lambda c: (
            ",".join(c) + ("\n#note\nTime [s],Current [A],T_winding [°C],T_ambient [°C]" if c[0] == "445" else "")
        ),
    ),
    "a japanese logger and its table of channels": Format(
        "xtyIWA",
        "番号;日時;ms;CH1;CH2;CH3",
        before="メーカー,Graphtec\n測定間隔,5s\nCH1,電流,DC,20A\nCH2,巻線,TEMP,TC_K\nCH3,室温,TEMP,TC_K\n",
        units="NO.;時刻;ms;A;degC;degC",
        cells=COUNT | {"y": lambda k: 0},
        stamp=at("%Y/%m/%d %H:%M:%S"),
        encoding="cp932",
    ),
    "units in a table of channels": Format(
        "xtWAI",
        "No.;Time;U1-1;U1-2;U2-1",
        before='"CH","Mode","Range","Comment","Unit"\n"U1-1","Tc","K","Winding","°C"\n"U1-2","Tc","K","Room","°C"\n'
        '"U2-1","V","1V","Current","A"\n\n',
        cells=COUNT,
        stamp=at("%Y-%m-%d %H:%M:%S.0"),
    ),
    "rows of settings under a name each": Format(
        "tIWA",
        ";Current;Twinding;Troom",
        before='"BlockNumber",1\n"TraceName","Current","Twinding","Troom"\n"BlockSize",90,90,90\n"VUnit","A","C","C"\n'
        '"SampleRate",0.2,0.2,0.2\n"HResolution",5.0,5.0,5.0\n"HOffset",0.0,0.0,0.0\n"HUnit","s","s","s"\n\n',
        doubt="rows 5 s apart as the lines before its header say",
    ),
    "a clock at the end of a path": Format(
        "tIWA",
        "Platform()://DS1202/Time;"
        + ";".join(f"Platform()://DS1202/Model Root/{n}" for n in ("i_s[A]", "T_wdg[°C]", "T_amb[°C]")),
        before='descriptions\ntype,"csv"\ndelimiter,","\ntrace_values\n',
        doubt="seconds are assumed",
    ),
    "chinese dates": Format(
        "xtIWA",
        "序号;采样时间;电机电流(A);绕组温度(℃);环境温度(℃)",
        stamp=at("%Y年%m月%d日 %H时%M分%S秒"),
        cells=COUNT,
        encoding="gb18030",
    ),
    "channels with colons before units": semicolons(
        "xtWHI",
        "DATE:;TIME:;M00: °C;M01: °C;M10: A",
        cells={"x": at("%d.%m.%y")},
        stamp=at("%H:%M:%S"),
        before="ALMEMO 2890-9\n",
    ),
    "kinds in columns of units": Format(
        "xytWzHz",
        "Place;Date;Time;Value;Unit;Value 2;Unit 2",
        "\t",
        cells={"x": lambda k: k % 9, "y": at("%Y/%m/%d"), "z": lambda k: "TEMP C"},
        stamp=at("%H:%M:%S"),
    ),
    "the air in french": semicolons(
        "tIWHA", "Heure;Intensité (A);T° bobinage (°C);T° carcasse (°C);T° ambiance (°C)", stamp=at("%H:%M:%S")
    ),
    "statistics before the names": Format(
        "tIWA", before="Statistics\n,I,W,A\nMean,4.5,50.0,22.0\nMax,9.0,84.0,22.1\nMin,0.0,24.0,21.9\n\n"
    ),
    "a web server's dates": Format("tIWA", f"Time;{IWA}", stamp=at("%d/%b/%Y:%H:%M:%S")),
    "greek": semicolons("tIWA", "Χρόνος (s);Ρεύμα (A);Θερμοκρασία τυλίγματος (°C);Θερμοκρασία περιβάλλοντος (°C)"),
    "danish": semicolons("tIWA", "Tid;Strøm;Viklingstemperatur;Rumtemperatur", doubt="assumed"),
    "numbers of Fortran": Format(
        "tIWA",
        "T(S);I(A);TWIND(C);TAIR(C)",
        "  ",
        row=lambda c: "".join(f"{float(x):13.5E}" for x in c).replace("E", "D"),
    ),
    "a word between date and time": semicolons("tIWA", f"Aika;{IWA}", stamp=at("%d.%m.%Y klo %H.%M.%S")),
    "units in columns beside readings": Format(
        "tIxWyAz",
        "Time [s];Ch1_Value;Ch1_Unit;Winding_Value;Winding_Unit;Room_Value;Room_Unit",
        cells={"x": lambda k: "A", "y": lambda k: "C", "z": lambda k: "C"},
    ),
    "one blank between names, several between readings": Format(
        "tIWA",
        "% t[s];I[A];T_winding[C];T_amb[C]",
        " ",
        before="% third run\n",
        row=lambda c: "  ".join(f"{x:>9}" for x in c),
    ),
    "apparent power beside a speed": Format("txyInWA", "Time [s];S-1;Q-1;Irms-1;Speed;Aux1(T_coil);Aux2(T_room)"),
    "a clock under the names": semicolons(
        "tIWA", "Name;Strom;Wicklung;Raum", units="Einheit;A;°C;°C\nZeit [ms];;;", stamp=lambda k: str(5000 * k)
    ),
    "a line of nothing between all rows": Format("tIWA", ending="\r\n\r\n"),
    "a comment sign before names and units": Format(
        "tIWA", "% time;current;winding;room", " ", units="% s;A;degC;degC"
    ),
    "turkish minutes": semicolons(
        "tIWA", "Zaman (dk);Akım (A);Sargı (°C);Ortam (°C)", stamp=lambda k: f"{k * 5}", step_s=300.0, encoding="cp1254"
    ),
    "months in MM beside minutes in mm": Format(
        "uvwxytIWA",
        f"YYYY;MM;DD;hh;mm;ss.fff;{IWA}",
        cells={c: at(f) for c, f in zip("uvwxy", ("%Y", "%m", "%d", "%H", "%M"))},
        stamp=at("%S.000"),
    ),
    "a year behind an apostrophe": Format(
        "tInWA",
        "日時;CH01 電流[A];CH02 回転速度[r/min];CH03 モータ巻線[℃];CH04 室温[℃]",
        before="ロガー,NR\nサンプリング,5s\n\n",
        stamp=at("'%y-%m-%d %H:%M:%S"),
        encoding="cp932",
    ),
    "korean halves of a day": Format(
        "tInWHA",
        "일시;전류(A);회전속도(rpm);권선온도(℃);외함온도(℃);주위온도(℃)",
        stamp=lambda k: korean(BEGUN + timedelta(seconds=5 * k - 200)),
        encoding="cp949",
    ),
    "hours, minutes and seconds in one number": Format("tIWA", f"TIME;{IWA}", stamp=at("%H%M%S", 20), step_s=20),
    "thai": Format("tIWHA", "เวลา (วินาที);กระแส (A);อุณหภูมิขดลวด (°C);อุณหภูมิตัวเรือน (°C);อุณหภูมิห้อง (°C)"),
    "finnish": semicolons(
        "tInWHBA", "Aika [s];Virta [A];Pyörimisnopeus [1/min];Käämi U [°C];Runko [°C];Laakeri [°C];Ympäristö [°C]"
    ),
    "slovene, and a brake in words": semicolons(
        "tInWHAz",
        "Čas (s);Tok (A);Vrtljaji (vrt/min);Navitje (°C);Ohišje (°C);Okolica (°C);Bremse",
        encoding="cp1250",
        cells={"z": lambda k: "offen" if k // 7 % 2 else "zu"},
        switches=("Bremse",),
    ),
    "turkish halves of a day": semicolons(
        "xtIWA",
        "Tarih;Saat;Akım (A);Sargı (°C);Ortam (°C)",
        cells={"x": at("%d.%m.%Y")},
        stamp=lambda k: turkish(BEGUN + timedelta(seconds=5 * k - 200)),
        encoding="cp1254",
    ),
    "the largest and the least of every channel": Format(
        "tnWxyAzv",
        "Time (s);RPM/AVE (rpm);"
        + ";".join(f"{c}/{q} (°C)" for c in ("Winding", "Ambient") for q in ("AVE", "Max", "Min")),
        cells={c: beside(*of) for c, of in {"x": "W+", "y": "W-", "z": "A+", "v": "A-"}.items()},
    ),
    "an efficiency, and units of a dynamometer": Format(
        "tIMnxWA",
        "t [s];I_eff;Torque (lbf-ft);shaft_speed_radps;Eff1[%];winding_temp_degc;T room [°C]",
        scale={"M": (1 / 1.3558179, 0.0), "n": RADS},
        digits=4,
        doubt="no unit: A is assumed",
    ),
    "rates of channels under their units": Format(
        "tIWA", "Zeit;Strom;Wicklung;Raum", "\t", ",", units="s;A;°C;°C\n1 Hz\t1 Hz\t0,2 Hz\t0,2 Hz"
    ),
    "milliseconds in brackets": Format(
        "tWAI",
        "",
        stamp=lambda k: str(5000 * k + 812),
        row=lambda c: f"[{c[0]}] Tcoil={c[1]}C | Troom={c[2]}C | I={c[3]}A",
        doubt="ms are assumed",
    ),
    "losses in polish": semicolons("tPWHA", "Czas;moc_strat;Uzwojenie;Korpus;Otoczenie", doubt="W is"),
}
