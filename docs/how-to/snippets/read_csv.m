% trajectory.csv in Octave: columns by their label; empty cells become NaN.
file = fopen(argv(){1});
names = strsplit(fgetl(file), ",");
format = repmat("%f", 1, numel(names));
table = cell2mat(textscan(file, format, "Delimiter", ",", "EmptyValue", NaN));
fclose(file);
column = @(name) table(:, strcmp(names, name));

t = column("t [s]");  energy = column("energy [J]");
printf("%d samples to %g s, largest change of energy %.3g J\n", numel(t), t(end), max(abs(energy - energy(1))));
