// The charts of a flight: which signals of which table (flight_signals.cpp) stand together. A part is what is compared
// between flights: with one flight its parts share a chart, with several each part has a chart of its own.
'use strict';

swiftlet.flightPanels = (() => {
  const axes = ['north', 'east', 'down'];
  const bodyAxes = ['x', 'y', 'z'];
  // Lines: [table, signal, role, label if it differs from that of the part].
  const parts = (labels, lines) => labels.map((label, i) => ({label, lines: lines(label, i)}));
  const rotors = (table) =>
      parts([1, 2, 3, 4, 5, 6, 7, 8].map((i) => `rotor ${i}`), (label, i) => [[table, `rotor[${i + 1}]`, 'value']]);
  const single = (label, ...lines) => [{label, lines}];

  return [
    {
      group: 'Position', title: 'Position', unit: 'm, NED',
      parts: parts(axes, (axis) => [['path', axis, 'value'], ['reference', axis, 'reference', 'reference']]),
    },
    {
      group: 'Position', title: 'Position error', unit: 'mm',
      parts: [
        ...parts(axes, (axis) => [['reference', `error_${axis}`, 'value']]),
        {label: '3-D', lines: [['reference', 'error_3d', 'value']]},
      ],
    },
    {
      group: 'Position', title: 'Velocity', unit: 'm/s, NED',
      parts: parts(axes, (axis) => [['path', `v_${axis}`, 'value'], ['reference', `v_${axis}`, 'reference', 'reference']]),
    },
    {
      group: 'Position', title: 'Speed', unit: 'm/s',
      parts: single('speed', ['path', 'speed', 'value'], ['limits', 'speed', 'limit', 'limit']),
    },
    {
      group: 'Position', title: 'Acceleration', unit: 'm/s²',
      parts: single('acceleration', ['path', 'acceleration', 'value'], ['limits', 'acceleration', 'limit', 'limit']),
    },
    {
      group: 'Position', title: 'Tilt of the thrust', unit: '°',
      parts: single('tilt', ['path', 'tilt', 'value'], ['limits', 'tilt', 'limit', 'limit']),
    },
    {
      group: 'Attitude', title: 'Attitude', unit: '°',
      parts: parts(['roll', 'pitch', 'yaw'], (angle) => [['path', angle, 'value'], ['reference', angle, 'reference', 'setpoint']]),
    },
    {
      group: 'Attitude', title: 'Body rates', unit: 'rad/s, FRD',
      parts: parts(['p', 'q', 'r'], (rate) => [['path', rate, 'value']]),
    },
    {
      group: 'Attitude', title: 'Gyroscope', unit: 'rad/s, FRD',
      parts: parts(['p', 'q', 'r'], (rate) => [['imu', rate, 'value']]),
    },
    {
      group: 'Attitude', title: 'Specific force', unit: 'm/s², FRD',
      parts: parts(bodyAxes, (axis) => [['imu', `force_${axis}`, 'value']]),
    },
    {group: 'Rotors', title: 'Rotor commands', unit: 'share of full', parts: rotors('command')},
    {group: 'Rotors', title: 'Rotor speeds', unit: 'rad/s', parts: rotors('rotor_speeds')},
    {
      group: 'Rotors', title: 'Rotor commands clipped since the last status', unit: '1: yes',
      parts: single('saturated', ['status', 'saturated', 'value']),
    },
    {
      group: 'Battery', title: 'Supply voltage', unit: 'V',
      parts: single('voltage', ['battery', 'voltage', 'value'], ['status', 'low_voltage', 'limit', 'low'],
                    ['status', 'critical_voltage', 'limit', 'critical']),
    },
    {group: 'Battery', title: 'Current', unit: 'A', parts: single('current', ['battery', 'current', 'value'])},
    {group: 'Battery', title: 'State of charge', unit: '%', parts: single('charge', ['battery', 'charge', 'value'])},
    {
      group: 'Estimator', title: 'Estimate minus ground truth, position, with 3 σ', unit: 'mm',
      parts: parts(axes, (axis) => [['estimate', `deviation_${axis}`, 'value'], ['estimate', `bound_${axis}`, 'bound', '3 σ']]),
    },
    {
      group: 'Estimator', title: 'Estimate minus ground truth, velocity, with 3 σ', unit: 'mm/s',
      parts: parts(axes, (axis) => [['estimate', `deviation_v_${axis}`, 'value'], ['estimate', `bound_v_${axis}`, 'bound', '3 σ']]),
    },
    {
      group: 'Estimator', title: 'Estimate minus ground truth, rotation, with 3 σ', unit: '°',
      parts: parts(axes, (axis) => [
        ['estimate', `deviation_rotation_${axis}`, 'value'], ['estimate', `bound_rotation_${axis}`, 'bound', '3 σ'],
      ]),
    },
    {
      group: 'Estimator', title: 'Innovation: pose minus estimate, position, with 3 σ of both', unit: 'mm',
      parts: parts(axes, (axis) => [['innovation', axis, 'value'], ['innovation', `bound_${axis}`, 'bound', '3 σ']]),
    },
    {
      group: 'Estimator', title: 'Innovation: pose minus estimate, rotation, with 3 σ of both', unit: '°',
      parts: parts(axes, (axis) => [
        ['innovation', `rotation_${axis}`, 'value'], ['innovation', `bound_rotation_${axis}`, 'bound', '3 σ'],
      ]),
    },
    {
      group: 'Estimator', title: 'Gyroscope bias', unit: 'rad/s',
      parts: parts(bodyAxes, (axis) => [['estimate', `gyro_bias_${axis}`, 'value']]),
    },
    {
      group: 'Estimator', title: 'Accelerometer bias', unit: 'm/s²',
      parts: parts(bodyAxes, (axis) => [['estimate', `accelerometer_bias_${axis}`, 'value']]),
    },
    {group: 'Estimator', title: 'Age of the last used pose', unit: 'ms', parts: single('age', ['estimate', 'pose_age', 'value'])},
    {
      group: 'Estimator', title: 'Refused poses', unit: 'count',
      parts: single('refused', ['estimate', 'poses_refused', 'value']),
    },
    {
      group: 'Latency', title: 'From IMU sample to its command', unit: 'µs',
      parts: single('latency', ['latency', 'imu_to_command', 'value']),
    },
    {
      group: 'Latency', title: 'Sense to actuate, since the rotors started', unit: 'µs',
      parts: parts(['p50', 'p99', 'max'], (name) => [['vehicle', `sense_to_actuate_${name}`, 'value']]),
    },
    {
      group: 'Latency', title: 'Step of the controller', unit: 'µs',
      parts: [
        {label: 'longest step', lines: [['status', 'longest_step', 'value']]},
        {label: 'jitter, p99', lines: [['status', 'jitter_p99', 'value']]},
      ],
    },
    {
      group: 'Latency', title: 'Delay of the loop', unit: 'ms',
      parts: [
        {label: 'p50', lines: [['status', 'loop_delay_p50', 'value']]},
        {label: 'p95', lines: [['status', 'loop_delay_p95', 'value'], ['status', 'delay_margin', 'limit', 'margin']]},
      ],
    },
  ];
})();
