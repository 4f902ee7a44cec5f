function y = thermal_solve(model, time, signals, x0)
% Reference solver of an exported thermal network. y (time x output) degC; signals: struct of columns, one per input and
% boundary; x0: first temperatures of model.states. For example:  load model.mat; disp(char(model.about));
  options = odeset('RelTol', 1e-6, 'AbsTol', 1e-4, 'MaxStep', max(diff(time)));
  [~, x] = ode15s(@(t, x) flow(model, x, at(time, signals, t)) ./ model.C, time, x0, options);
  z = [x, cell2mat(cellfun(@(b) signals.(b.name)(:), model.boundaries', 'UniformOutput', false))];
  y = cell2mat(cellfun(@(o) z(:, o.col) * o.val, model.outputs', 'UniformOutput', false));
end
function u = at(time, signals, t)
  u = structfun(@(v) interp1(time, v, t), signals, 'UniformOutput', false);
end
function F = flow(model, x, u)
  z = [x; cellfun(@(b) u.(b.name), model.boundaries); 1];
  F = -model.K0 * z;
  for k = 1:numel(model.terms)
    t = model.terms{k}; f = 0;
    for j = 1:numel(t.factor)
      p = t.factor{j}; f = f + p.coefficient * prod([1; cellfun(@(g) value(g, u), p.functions(:))]);
    end
    c = f * law(t.law, sum(t.hot.val .* z(t.hot.col)), sum(t.cold.val .* z(t.cold.col)), u);
    F = F - accumarray(t.row, c * t.val .* z(t.col), size(F));
  end
end
function v = value(f, u)
  x = u.(f.input);
  switch f.kind
    case 'power', v = abs(x / f.at) ^ f.exponent;
    case 'straight', v = f.offset + f.slope * x;
    case 'positive', v = double(f.way * x > 0);
    case 'table', if f.size, x = abs(x); end, v = interp1(f.x, f.y, held(x, f.x));
    case 'map'
      w = u.(f.other); if f.size, x = abs(x); w = abs(w); end
      v = interp2(f.x2, f.x1, f.y, held(w, f.x2), held(x, f.x1));
  end
end
function x = held(x, grid), x = min(max(x, grid(1)), grid(end)); end
function v = film(g, hot, cold)
  v = interp2(g.x, g.films, g.y, held(abs(hot - cold), g.x), held((hot + cold) / 2, g.films));
end
function v = stream(g, hot, cold, u)
  T = held(hot + cold, g.total); u = max(abs(u), 1e-9);
  at = max(log(u) - interp1(g.total, g.shift, T), g.x(1));
  v = interp1(g.total, interp1(g.x, g.y', at, 'linear', 'extrap'), T);
  if isfield(g, 'still'), s = film(g.still, hot, cold); v = (v ^ 3 + s ^ 3) ^ (1 / 3) - s;
  elseif g.b > 0, v = max(v, expm1(min(v * g.b / u, 5)) * u / g.b); end
end
function v = law(g, hot, cold, u)
  d = abs(hot - cold); h = hot + 273.15; c = cold + 273.15;
  switch g.kind
    case 'constant', v = 1;
    case 'power', v = (d ^ 2 + 1e-4) ^ (g.a / 2);
    case 'radiation', v = 5.670374419e-8 * (h ^ 2 + c ^ 2) * (h + c);
    case 'linear', v = 1 + g.a * (hot - g.b);
    case 'inverse', v = 1 / (1 + g.a * (hot - g.b));
    case 'table', if g.x(1) < 0, d = hot - cold; end, v = interp1(g.x, g.y, held(d, g.x));
    case 'film table', v = film(g, hot, cold);
    case 'stream table'
      if isempty(g.input), v = stream(g, hot, cold, g.size); else, v = stream(g, hot, cold, u.(g.input)); end
  end
end
