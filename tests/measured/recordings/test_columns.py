"""Where columns go by their names, their units and what they read: a header, its readings, and the truth of each."""

import numpy as np
import pytest
from logger_formats import signals

from geom.description.names import plain_header
from measured.importing import guess
from measured.importing.case_files import read_runs
from thermoscope.commands.test.new import first_model

# Readings by the letters of logger_formats, and more: V w u j winding but for a little, X between winding and room, Y y
# outside, Q i a near the room, D E h dead, k kelvin, e a rate; Z b current, r rad/s, q torque, p m g power either way
# round or both, 1 2 its phases, s a sum; O N c on and off, S a flow, F a fan, L a level, d a heading, x a longitude.
S = signals(5.0)
T, W, A, I = S["t"], S["W"], S["A"], S["I"]  # noqa: E741
ON = I / 9.0
S |= {"V": W + 1.31, "X": A + 0.2 * (S["H"] - A), "Y": A - 15.0, "D": 39.2 + 0.0 * T, "Z": 2.0 * I, "b": I / 3.0}
S |= {"O": (T // 85) % 2, "N": 1.0 - ON, "S": 4.0 + 0.1 * np.sin(T), "F": np.where(T > 200, 1200.0, 600.0)}
S |= {
    "k": W + 273.15,
    "h": 295.15 + 0.0 * T,
    "E": 14.25 + 0.0 * T,
    "e": np.gradient(W, T),
    "r": S["n"] / 10.0,
    "L": 20.0 + 80.0 * (T > 150),
}
S |= {"p": 9.0 * I + 3.0, "1": 0.33 * (9.0 * I + 3.0), "2": 0.34 * (9.0 * I + 3.0), "m": -(9.0 * I + 3.0)}
S |= {
    "g": np.sign(T - 100.0) * (9.0 * I + 3.0),
    "s": I + S["n"],
    "j": W + 3.0 * np.sin(T),
    "l": S["H"] + 3.0 * np.sin(T),
}
S |= {"q": 4.0 + S["M"], "y": 0.5 * (A - 20.0), "u": W - 0.1, "a": A - 0.1, "i": A + 0.1, "Q": A + 15.0, "c": ON}
S |= {
    "o": 1e4 + T,
    "w": W + np.sin(T),
    "d": (7.0 * T) % 360,
    "x": 11.5 + 1e-5 * T,
    "v": 3.7 + 0.01 * I,
    "J": 60.0 + 0.1 * np.sin(T),
}


# Header but for its clock | its readings | where each goes, - for nowhere | doubts, each with the columns that have it
GOES = """
T_wdg [C],T_frame [C],T_xyz [C],I [A] | WHAI | wdg frame ambient current_A
T_wdg [C],T_frame [C],T_xyz [C],I [A] | WHJI | wdg frame xyz current_A
Camera [C],Parete esterna [C],Aria ambiente [C],I [A] | WHAI | camera housing ambient current_A
i_rms,w_mech,T_load,T_winding,T_housing,T_amb | IrHWBA | current_A speed_rpm load winding housing ambient
winding_temperature,living_room_temperature,outdoor_temperature,P [W] | WAYp | winding ambient - power_W
winding.T,fixedTemperature.T,der(winding.T),loss.Q_flow,motor.w,motor.tau,motor.i_rms
  | kheprMI | winding ambient - power_W speed_rpm torque_Nm current_A
V(tj),V(theatsink),V(tamb),I(P) | WHAI | v-tj v-heatsink ambient current_A
T_core [degC],Aceite superior [degC],Aceite inferior [degC],Room [degC],I [A]
  | WHBAI | core aceite-superior aceite-inferior ambient current_A
T_core [degC],Tank oil [degC],Cooler outlet oil [degC],Room [degC],I [A]
  | WHBAI | core tank-oil cooler-outlet-oil ambient current_A
T_core [degC],T_oil [degC],Oil inlet [degC],Room [degC],I [A] | WHBAI | core - coolant ambient current_A
T_core [degC],T_oil [degC],T_water in [degC],Room [degC],I [A] | WHBAI | core - coolant ambient current_A
T_winding [degC],T_oil [degC],Room [degC],I [A],Oil flow [l/min]
  | WHAIS | winding coolant ambient current_A flow_l_min
Tcoil [C],Tair [C],Pa [W],Pb [W] | WApI | coil ambient power_W pb_W
T_module [C],T_heatsink [C],T_air [C],P [W] | WHAp | module heatsink ambient power_W
T_module [C],T_heatsink [C],T_air [C],P [W],Speed [rpm] | WHApn | module - ambient power_W speed_rpm
T coil [C],T air [C],P1 [W],P2 [W],P3 [W],Power in [W] | WA121p | coil ambient - - - power_W
T coil [C],T air [C],Pcu loss [W],Pfe loss [W],Total loss [W] | WAIns | coil ambient power_W pfe_loss_W total_loss_W
T coil [C],T air [C],Power [W],Speed [rpm] | WApn | coil ambient power_W speed_rpm
T coil [C],T air [C],Power [W],Speed [rpm] | WAmn | coil ambient power_W speed_rpm
T coil [C],T air [C],Power [W],Speed [rpm] | WAgn | coil ambient - speed_rpm
T coil [C],1 <Air in> [C],2 <Air out> [C],I [A] | WAXI | coil ambient - current_A
T coil [C],1 <Air in> [C],2 <Air out> [C],I [A],Room [C] | WAXIA | coil coolant - current_A ambient
T_stator,T_stator_filtered,room [°C],I_batt [A],I_phase [A],eta [%] | WWAbII | stator - ambient - current_A -
winding [°C],room [°C],I_rms_mean,I_rms_rms | WAII | winding ambient - current_A
cadence_rpm,motor_rpm,motor_temp [°C],I [A] | LnWI | cadence_rpm speed_rpm motor current_A
motortemp,settemp,cputemp,vehicle_speed,wind speed,room [°C],I [A]
  | WHVnIAI | motor - - vehicle_speed_mps wind_speed_mps ambient current_A
winding [°C],EXHAUST [°C],I [A],room [°C] | WHIA | winding - current_A ambient
winding [°C],EXHAUST [°C],I [A],frame [°C] | WAIH | winding coolant current_A frame
I [A],T_winding [°C],T_cabinet [°C] | IWA | current_A winding ambient
I [A],T_winding [°C],T_Schaltschrank [°C] | IWA | current_A winding ambient
I [A],T_winding [°C],T_cabinet [°C],Room [°C] | IWAA | current_A winding - ambient
I [A],T_winding [°C],T_Schaltschrank [°C],Room [°C] | IWAA | current_A winding - ambient
I [A],T_winding [°C],T_cabinet [°C] | IHW | current_A winding -
I [A],T_winding [°C],T_Schaltschrank [°C] | IHW | current_A winding -
Longitude,Bearing,T_winding [°C],T_amb [°C],I [A] | xdWAI | - - winding ambient current_A
Bearing 2,Bearing,T_winding [°C],T_amb [°C],I [A] | HHWAI | bearing-2 bearing winding ambient current_A
T_stator [°C],Ambient temp (converter) [°C],Nacelle ambient temp [°C],I [A] | WHAI | stator - ambient current_A
batt_v,batt_i,T_cell [°C] | vIW | voltage_V current_A cell
V,I,T_cell [°C] | vIW | voltage_V current_A cell
Voltage_load,Current_load,T_cell [°C] | vIW | voltage_V current_A cell
pack.v,pack.i,T_cell [°C] | vIW | voltage_V current_A cell
T_u,T_v,T_w,T_i | WVwA | u v w ambient
boiler,return,burner,room [°C] | WHOA | boiler coolant burner_percent ambient
T_winding,Outlet air [°C],Inlet air [°C] | WWA | winding - coolant
101 Winding <TC K> (C),101 Winding Max (C),102 Frame <TC K> (C),103 Amb <RTD> (C),104 I (A)
  | WVHAI | 101-winding - 102-frame ambient current_A
T_winding [degC],T_room [degC],i_a [A],position [rad],fault,mode,rev | WAIoDDD | winding ambient current_A - - - -
T_winding [degC],T_room [degC],I [A],T_spare [degC] | WAIW | winding ambient current_A -
water inlet [C],water outlet [C],power [W] | AWp | coolant water-outlet power_W
T_ambient [C],T_module [C],Irradiance [W/m2] | AWp | ambient module share_percent
T_ambient [C],T_module [C],Solar radiation (W/m^2) | AWp | ambient module share_percent
internal_air,external_air,internal_wall,heater_power | HYBp | internal-air ambient internal-wall power_W
T.motor,T.amb,dc.v,dc.i | WAvI | motor ambient voltage_V current_A
T_out,T_kitchen,T_brine_out,power [W] | YHyp | ambient kitchen - power_W
gpu_load,ssd_load,gpu_hotspot,ssd_temp | LZWH | share_percent ssd_load_percent gpu-hotspot ssd
T1,T2,Q1,Q2 | WALD | part-1 part-2 share_percent q_2_percent
T1,T2,Q3 | WHL | part-1 part-2 -
cpu_temp,gpu_temp,cpu_load,gpu_util,mem_pct | WHLZD | cpu gpu share_percent gpu_util_percent -
T_winding,duty | Wm | winding -
cpu_power_w,gpu_core_temp_c,gpu_power_w | pWL | cpu_power_W gpu-core power_W
temperature,setpoint,output | WDL | part - share_percent
temperature,humidity,output | WDL | part - -
T_winding,Current speed | WL | winding speed_rpm
T_winding,PID output | WL | winding share_percent
T_winding,controller output | WL | winding share_percent
T_winding,CoolantTemp,PumpRpm | WHF | winding coolant flow_percent
T_winding,T_case,PumpRpm | WHF | winding case speed_rpm
T_winding,T_case,fan_rpm | WHF | winding case flow_percent
T_winding,CoolantTemp,motor pump rpm | WHF | winding coolant speed_rpm
Zone 1 [degC],Zone 2 [degC],T_amb [degC],Puissance chauffe 1 [W],Puissance chauffe 2 [W]
  | WHApZ | zone-1 zone-2 ambient power_W puissance_chauffe_2_W
Zone 1 [degC],Zone 2 [degC],T_amb [degC],Heizung 1 [W],Heizung 2 [W]
  | WHApZ | zone-1 zone-2 ambient power_W heizung_2_W
Zone 1 [degC],Zone 2 [degC],T_amb [degC],Potenza riscaldamento 1 [W],Potenza riscaldamento 2 [W]
  | WHApZ | zone-1 zone-2 ambient power_W potenza_riscaldamento_2_W
Zone 1 [degC],Zone 2 [degC],T_amb [degC],Heater power 1 [W],Heater power 2 [W]
  | WHApZ | zone-1 zone-2 ambient power_W heater_power_2_W
T coil/AVE [C],T coil/MIN [C],T coil/MAX [C],T Cell/AVE [C],T Cell/MIN [C],T Cell/MAX [C],I [A]
  | WuVAaiI | coil-ave - - ambient - - current_A
T_winding [°C],T_EM_COOL_OUT [°C],T_EM_COOL_IN [°C],T_TESTCELL [°C],I [A]
  | WXQAI | winding - coolant ambient current_A
T_winding [°C],Water out [°C],Water in [°C],Test cell [°C],I [A] | WXQAI | winding - coolant ambient current_A
T_winding [°C],냉각수출구온도 [°C],냉각수입구온도 [°C],Prüfzelle [°C],I [A]
  | WXQAI | winding - coolant ambient current_A
T_winding [°C],T_EM_COOL_OUT [°C],T_EM_COOL_IN [°C],Prüfraum [°C],I [A] | WXQAI | winding - coolant ambient current_A
T_winding [°C],Water out [°C],Water in [°C],Cella di prova [°C],I [A] | WXQAI | winding - coolant ambient current_A
T_winding [°C],Voda izlaz [°C],Voda ulaz [°C],Test cell [°C],I [A] | WXQAI | winding - coolant ambient current_A
i_rms,w_mech,T_load,T_winding,T_housing,T_amb
  | IrqWHA | current_A speed_rpm torque_Nm winding housing ambient | AS_TORQUE 3
hotspot,heatsink,ambient,I [A] | WHAI | hotspot heatsink ambient current_A | OF_TESTED 2
temps.igbt,temps.heatsink,ambient,I [A] | WHAI | igbt heatsink ambient current_A | OF_INSTRUMENT 1 2
buffer_tank_temperature,living_room_temperature,outdoor_temperature,P [W]
  | WAYp | buffer-tank living-room ambient power_W | INDOORS 2
temp_mos_1,temp_motor,I [A] | WDI | mos-1 - current_A | OF_INSTRUMENT 1; DEAD 2
T_1 [°C],T_2 [°C],I [A] | DEI | part-1 ambient current_A | DEAD 1 2
Motor 1 coil [C],Motor 2 coil [C],Air [C],I [A]
  | WHAI | motor-1-coil motor-2-coil ambient current_A | NUMBERED_MACHINE 1 2
Cell 1 [C],Cell 2 [C],Air [C],I [A] | WHAI | cell-1 cell-2 ambient current_A | AS_WINDING
Cell 1 [C],Cell 2 [C],Air [C],I [A],Speed [rpm] | WHAIn | cell-1 cell-2 ambient current_A speed_rpm | AS_WINDING 1
T_pm,T_pm_hat,T_pm_kf,room [°C],OTI_A,I [A] | WHwANI | pm - pm-kf ambient - current_A | VARIANT 3
winding measured [°C],winding LPTN [°C],frame meas [°C],frame XQZ [°C],odometer_km,Temp INV [%]
  | WjHloL | winding-measured - frame-meas frame-xqz - - | VARIANT 4
Q7 [%],I [A],T_winding [°C],T_room [°C] | LIWA | share_percent current_A winding ambient | OF_WHAT 1
"""
ROWS = [[part.strip() for part in row.split(" | ")] for row in GOES.strip().replace("\n  |", " |").splitlines()]


@pytest.mark.parametrize("row", ROWS, ids=[row[0] for row in ROWS])
def test_where_columns_go(tmp_path, row):
    header, letters, goes, *doubts = row
    cells = zip(*(S[c] for c in f"t{letters}"), strict=True)
    lines = [f"t [s],{header}", *(",".join(f"{v:.6g}" for v in values) for values in cells)]
    (tmp_path / "a.csv").write_text("\n".join(lines) + "\n")
    [(source, clock)] = read_runs(tmp_path / "a.csv")
    found = {g.column: g for g in guess.guesses(source, clock.columns, first_model([(source, clock)], {}).target)}
    every = [found[plain_header(name)] for name in header.split(",")]
    assert " ".join(g.place or g.feeds or "-" for g in every) == goes
    for name, *columns in map(str.split, doubts[0].split("; ") if doubts else ()):
        doubted = [str(k) for k, g in enumerate(every, 1) if getattr(guess, name) in g.doubt]
        assert doubted == columns, name
