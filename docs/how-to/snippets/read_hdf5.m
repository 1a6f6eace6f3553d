% run.h5 in Octave: one dataset a column.
run = load("-hdf5", argv(){1});
t = run.trajectory.t;  energy = run.trajectory.energy;
printf("%d samples to %g s, largest change of energy %.3g J\n", numel(t), t(end), max(abs(energy - energy(1))));
