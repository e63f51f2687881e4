#!/usr/bin/env python3
"""Draws the work-precision diagram and prints what an accuracy gets, and which fixed steps get it."""
import csv
import sys
from collections import defaultdict

import matplotlib

matplotlib.use('Agg')
import matplotlib.pyplot as plt  # noqa: E402

# Okabe and Ito's colours, told apart by the colour-blind.
COLOURS = {'euler': '#E69F00', 'verlet': '#0072B2', 'fourth_order': '#009E73',
           'implicit_euler': '#CC79A7', 'report': '#000000',
           'newton': '#0072B2', 'dynamics': '#E69F00', 'fire': '#009E73'}
MARKERS = {'euler': 'o', 'verlet': 's', 'fourth_order': '^', 'implicit_euler': 'v',
           'report': 'x', 'newton': 's', 'dynamics': '.', 'fire': '.'}
INTEGRATORS = ('euler', 'verlet', 'fourth_order', 'implicit_euler')
COLUMNS = 3  # of the picture, which is as wide as a page
WANTED_ERRORS = (1e-3, 1e-6, 1e-9)


def read_steps(path):
    """Rows of each scene and method, and the error of each scene's reference."""
    rows = defaultdict(lambda: defaultdict(list))
    references = {}
    with open(path, newline='') as file:
        for row in csv.DictReader(file):
            if row['method'] == 'reference':
                references[row['scene']] = float(row['trajectory_error'])
                continue
            rows[row['scene']][row['method']].append(
                {name: float(row[name]) for name in
                 ('time_step', 'time_per_second', 'trajectory_error', 'energy_error')})
    return rows, references


def read_relaxation(path):
    torques = defaultdict(list)
    with open(path, newline='') as file:
        for row in csv.DictReader(file):
            torques[row['method']].append((float(row['time']), float(row['max_torque'])))
    return torques


def read_accuracy(path):
    """Rows of each scene by the error asked for."""
    rows = defaultdict(dict)
    with open(path, newline='') as file:
        for row in csv.DictReader(file):
            rows[row['scene']][float(row['asked'])] = row
    return rows


def draw_errors(axes, rows, field, floor):
    for method, points in rows.items():
        if field == 'energy_error' and method == 'report':
            continue  # it keeps no account
        shown = [(p['time_per_second'], p[field]) for p in points if p[field] > 0]
        if shown:
            axes.loglog(*zip(*shown), marker=MARKERS[method], color=COLOURS[method],
                        markersize=4, linewidth=1, label=method)
    axes.axhline(floor, color='0.7', linewidth=0.8)
    axes.set_ylim(1e-15, 10)
    axes.grid(True, which='major', linewidth=0.3)


def draw_relaxation(axes, torques):
    for method, points in torques.items():
        axes.loglog(*zip(*points), marker=MARKERS[method], color=COLOURS[method],
                    markersize=3, linewidth=1, label=method)
    axes.set_title('relaxing the mesh')
    axes.set_xlabel('processor time [s]')
    axes.set_ylabel('largest torque [N m]')
    axes.legend()
    axes.grid(True, which='major', linewidth=0.3)


def draw_accuracy(axes, accuracy):
    for scene, rows in accuracy.items():
        axes.loglog(list(rows), [float(row['got']) for row in rows.values()], marker='.',
                    linewidth=1, label=scene)
    asked = sorted(next(iter(accuracy.values())))
    axes.fill_between(asked, [a / 5 for a in asked], [5 * a for a in asked], color='0.9')
    axes.set_title('automatic steps')
    axes.set_xlabel('error asked for [rad/s]')
    axes.set_ylabel('error got [rad/s]')
    axes.legend(fontsize=9)
    axes.grid(True, which='major', linewidth=0.3)


def draw(rows, references, accuracy, torques, path):
    """Scenes side by side, errors of positions above those of the energy; then automatic steps and
    the relaxation.
    """
    plt.rcParams['font.size'] = 12
    blocks = -(-len(rows) // COLUMNS)
    figure, grid = plt.subplots(2 * blocks + 1, COLUMNS, constrained_layout=True,
                                figsize=(4 * COLUMNS, 3.2 * (2 * blocks + 1)))
    columns = [grid[2 * block:2 * block + 2, column]
               for block in range(blocks) for column in range(COLUMNS)]
    for (above, below), (scene, methods) in zip(columns, rows.items()):
        draw_errors(above, methods, 'trajectory_error', references[scene])
        draw_errors(below, methods, 'energy_error', 1e-16)
        above.set_title(scene)
        below.set_xlabel('processor time / simulated time')
    for above, below in columns[:len(rows):COLUMNS]:
        above.set_ylabel('error of the positions [rad]')
        below.set_ylabel('relative error of the energy')
    draw_accuracy(grid[-1][0], accuracy)
    draw_relaxation(grid[-1][1], torques)
    for axes in [grid[-1][2], *sum(map(list, columns[len(rows):]), [])]:
        axes.axis('off')
    handles = {}
    for above, _ in columns[:len(rows)]:
        handles.update(zip(*reversed(above.get_legend_handles_labels())))
    grid[-1][2].legend(handles.values(), handles.keys(), loc='center', frameon=False,
                       title='the diagrams above')
    figure.savefig(path, dpi=110)


def cheapest(methods, error):
    """The method, step and time that reach an error for the least time."""
    candidates = [(p['time_per_second'], method, p['time_step'])
                  for method in INTEGRATORS for p in methods.get(method, ())
                  if p['trajectory_error'] <= error]
    return min(candidates) if candidates else None


def print_table(scenes, head, cell):
    """Print a row for each scene, and a column for each error: cell(what the scene has, error)."""
    print('| scene | ' + ' | '.join(head.format(e) for e in WANTED_ERRORS) + ' |')
    print('| --- |' + ' --- |' * len(WANTED_ERRORS))
    for scene, results in scenes.items():
        print(f'| {scene} | ' + ' | '.join(cell(results, e) for e in WANTED_ERRORS) + ' |')


def cheapest_in_words(methods, error):
    best = cheapest(methods, error)
    return f'`{best[1]}`, {best[2]:.2g} s' if best else 'not reached'


def got_in_words(rows, asked):
    """The error got, by which integrator, and its work."""
    row = rows[asked]
    return f'{float(row["got"]):.1e} by `{row["integrator"]}`, {float(row["cost"]):.2f}'


def main():
    if len(sys.argv) != 5:
        sys.exit('usage: plot_work_precision.py STEPS.csv ACCURACY.csv RELAXATION.csv PICTURE.png')
    rows, references = read_steps(sys.argv[1])
    accuracy = read_accuracy(sys.argv[2])
    draw(rows, references, accuracy, read_relaxation(sys.argv[3]), sys.argv[4])
    print_table(accuracy, '{:g} rad/s asked', got_in_words)
    print()
    print_table(rows, 'error {:g}', cheapest_in_words)


if __name__ == '__main__':
    main()
