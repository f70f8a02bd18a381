/* Forces of the benchmark's scenes as a plugin for Siconos: f[0] at time t. z is unused. */
#include <math.h>

static const double PI = 3.14159265358979323846;

void oscillator_force(double t, unsigned int size, double *f, unsigned int size_z, double *z)
{
  f[0] = cos(2.0 * t);
}

/* -(m c'' + k c) of the cam turning at 358 rpm; the same arcs as floor.py */
void cam_force(double t, unsigned int size, double *f, unsigned int size_z, double *z)
{
  const double mass = 1.221, stiffness = 1430.8, omega = 2.0 * PI * 358.0 / 60.0, period = 60.0 / 358.0;
  const double lift = PI / 2.0, nose = lift + 1.050328174371336, dwell = lift + 1.22173047639603;
  double a, b, rho;
  double beta = omega * (t - period * floor(t / period)) + lift;
  if (beta > 2.0 * PI) beta -= 2.0 * PI;
  if (beta > PI) beta = 2.0 * PI - beta;
  if (beta < lift) {
    f[0] = -stiffness * (0.40 - 0.3);
    return;
  }
  if (beta > dwell) {
    f[0] = -stiffness * (0.55393320723821 - 0.3);
    return;
  }
  if (beta <= nose) {
    a = -0.45 * sin(beta);
    b = 0.45 * cos(beta);
    rho = 0.85;
  } else {
    a = -0.40393320723821 * cos(beta + PI / 9.0);
    b = -0.40393320723821 * sin(beta + PI / 9.0);
    rho = 0.15;
  }
  const double root2 = rho * rho - b * b, root = sqrt(root2);
  const double second = -a - ((a * a - b * b) * root2 + a * b * a * b) / (root * root2);
  f[0] = -(mass * omega * omega * second + stiffness * (a + root - 0.3));
}
