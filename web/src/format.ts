// Numbers with units, for readers.

const PREFIXES: [number, string][] = [
  [1e9, "G"],
  [1e6, "M"],
  [1e3, "k"],
  [1, ""],
  [1e-3, "m"],
  [1e-6, "µ"],
  [1e-9, "n"],
];

/** At most `digits` significant digits, without trailing zeros. */
export function digits(value: number, count = 3): string {
  if (!Number.isFinite(value)) return "∞";
  if (value === 0) return "0";
  return String(Number(value.toPrecision(count))).replace("-", "−");
}

/** 15000, "Pa" -> "15 kPa". */
export function si(value: number, unit: string, count = 3): string {
  if (!Number.isFinite(value)) return `∞ ${unit}`;
  const size = Math.abs(Number(value.toPrecision(count)));
  const [factor, prefix] = PREFIXES.find(([f]) => size >= f) ?? (size === 0 ? [1, ""] : [1e-9, "n"]);
  return `${digits(value / factor, count)} ${prefix}${unit}`.trim();
}

/** A length with the unit people use for it: 0.05 -> "5 cm". */
export function length(value: number, count = 3): string {
  const size = Math.abs(value);
  if (size >= 0.01 && size < 1) return `${digits(100 * value, count)} cm`;
  return si(value, "m", count);
}

/** -0.02 -> "−2 %". */
export function percent(value: number, count = 3): string {
  return `${digits(100 * value, count)} %`;
}

/** The displayed form of a quantity of the protocol. */
export function quantity(value: number, unit: string, count = 2): string {
  if (unit === "") return percent(value, count);
  return unit === "m" ? length(value, count) : si(value, unit, count);
}

/** The smallest of 1, 2, 5 times a power of ten that is not below the value. */
export function niceAbove(value: number): number {
  if (!(value > 0)) return 1e-9;
  const power = 10 ** Math.floor(Math.log10(value) + 1e-12);
  for (const m of [1, 2, 5, 10]) if (m * power >= value * (1 - 1e-6)) return m * power;
  return 10 * power;
}
